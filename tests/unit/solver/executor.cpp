// What an executor must have a launch for: every shape of passes.
#include "kernels/pass_lambda.h"
#include "kernels/pass_levels.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

// CpuExec, of which one launch is hidden.
#define PBF_WITHOUT(launch)           \
  struct Without_##launch : CpuExec { \
    void launch() = delete;           \
  };
PBF_WITHOUT(items)
PBF_WITHOUT(pairs)
PBF_WITHOUT(shared)
PBF_WITHOUT(teams)
PBF_WITHOUT(bricks)
PBF_WITHOUT(listed)
PBF_WITHOUT(reduce)

/// One launch for all, which takes an item alone: a pass of another shape is not for it.
struct ItemsForAll : CpuExec {
  template <ItemPass Pass>
  void bricks(const Pass&) {}
};

/// As bits: items, pairs, shared, teams, bricks, reduce.
template <class P>
constexpr unsigned shapes_of() {
  return unsigned(ItemPass<P>) | unsigned(PairPass<P>) << 1 | unsigned(SharedPass<P>) << 2 |
         unsigned(TeamPass<P>) << 3 | unsigned(BrickPass<P>) << 4 | unsigned(ReducePass<P>) << 5;
}

}  // namespace

TEST_CASE("an executor without the launch of one shape of passes is none") {
  STATIC_REQUIRE(Executor<CpuExec>);
  STATIC_REQUIRE(!Executor<Without_items>);
  STATIC_REQUIRE(!Executor<Without_pairs>);
  STATIC_REQUIRE(!Executor<Without_shared>);
  STATIC_REQUIRE(!Executor<Without_teams>);
  STATIC_REQUIRE(!Executor<Without_bricks>);
  STATIC_REQUIRE(!Executor<Without_listed>);
  STATIC_REQUIRE(!Executor<Without_reduce>);
  STATIC_REQUIRE(!Executor<ItemsForAll>);
}

TEST_CASE("every pass has one shape: no launch takes a pass of another") {
  STATIC_REQUIRE(shapes_of<archetype::Item>() == 1);
  STATIC_REQUIRE(shapes_of<archetype::Pair>() == 2);
  STATIC_REQUIRE(shapes_of<archetype::Shared>() == 4);
  STATIC_REQUIRE(shapes_of<archetype::Team>() == 8);
  STATIC_REQUIRE(shapes_of<archetype::Brick>() == 16);
  STATIC_REQUIRE(shapes_of<archetype::Reduce>() == 32);
  STATIC_REQUIRE(shapes_of<LevelMovePass<float>>() == 1);
  STATIC_REQUIRE(shapes_of<DensityPass<float, ChunkedLists, Smoothing::consistent, Box<float>>>() ==
                 2);
  STATIC_REQUIRE(shapes_of<LevelReachPass>() == 4);
  STATIC_REQUIRE(shapes_of<LevelMultiplierPass<float>>() == 8);
  STATIC_REQUIRE(shapes_of<LevelSumPass<float, 3>>() == 16);
  STATIC_REQUIRE(shapes_of<MeasurePass<float, ChunkedLists, Box<float>>>() == 32);
}
