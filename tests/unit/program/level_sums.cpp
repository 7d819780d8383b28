// Sums at the nodes of all levels against the definition: level by level, each node from the finer
// ones around it, weights 1 and 1/2.
#include <cmath>
#include <random>

#include "kernels/pass_levels.h"
#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

/// A box of that many cells of the finest level.
LevelPlan boxes(int x, int y, int z) {
  const auto edge = [](int cells) { return std::to_string(0.4 * cells); };
  const bool flat = y == 0;
  const Scene s =
      scene_test::parse("domain: {min: [0, 0, 0], max: [" + edge(x) + ", " +
                        (flat ? "0.1" : edge(y)) + ", " + edge(z) +
                        "]}\n"
                        "fluid: {spacing: 0.1}\n"
                        "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.1, 0.4]}]\n"
                        "time: {step: 0.002, end: 1}\n"
                        "solver: {levels: on}\n" +
                        (flat ? "dimensions: 2\n" : ""));
  return make_plan(s, 1000).levels;
}

LevelShape cells_of(const LevelPlan& plan) {
  LevelShape cells;
  std::copy_n(plan.grid.cells, 3, cells.nodes);
  return cells;
}
template <class Pass>
void all_items(const Pass& pass) {
  for (int i = 0; i < pass.items(); ++i) pass.finish(i, pass.part(i, 0, 1));
}

/// f(LevelSums) in one go, or of levels 0 and 1 and then of the coarser ones from level 1.
template <class F>
void one_or_two_steps(const LevelPlan& plan, bool two, const std::int64_t* cell,
                      const std::int64_t* node, const F& f) {
  const int first = two ? 2 : plan.all.count;
  f(LevelSums{plan.all, 0, first, {cells_of(plan), true, 0, cell}});
  if (two) f(LevelSums{plan.all, first, plan.all.count, {plan.all.level[1], false, 1, node}});
}

/// Weight of node j of a level in the next one's node i, of so many.
double hat(int nodes, int i, int j) {
  return nodes == 1 ? 1 : std::max(0.0, 1 - std::abs(j - 2 * i) / 2.0);
}
/// Calls f(coarse node, finer node or cell, weight) for all that count, the finest first.
template <class F>
void by_definition(const LevelPlan& plan, const F& f) {
  const LevelHierarchy& all = plan.all;
  for (int l = 0; l < all.count; ++l) {
    const LevelShape fine = l == 0 ? cells_of(plan) : all.level[l - 1];
    for (int n = 0; n < all.level[l].size(); ++n)
      for (int m = 0; m < fine.size(); ++m) {
        const GridPlace a = all.level[l].place(n), b = fine.place(m);
        double weight = 1;
        for (int k = 0; k < 3; ++k)
          weight *= l > 0 ? hat(all.level[l].nodes[k], a[k], b[k])
                          : double(all.level[0].nodes[k] == 1 || b[k] == a[k] || b[k] == a[k] - 1);
        if (weight > 0) f(l, all.level[l].first + n, fine.first + m, weight);
      }
  }
}

LevelPlan some_boxes() {
  switch (GENERATE(0, 1, 2, 3, 4)) {
    case 0:
      return boxes(5, 3, 24);
    case 1:
      return boxes(12, 9, 7);
    case 2:
      return boxes(13, 0, 17);  // a plane
    case 3:
      return boxes(1, 1, 33);
    default:
      return boxes(16, 4, 8);
  }
}

}  // namespace

TEST_CASE("sums at nodes are those of the hats' definition, from the cells and from level 1") {
  const LevelPlan plan = some_boxes();
  const bool two_steps = GENERATE(false, true);
  REQUIRE(plan.all.count > 2);
  std::mt19937 random(7);
  std::vector<std::int64_t> cell(std::size_t(plan.cells())), sum(std::size_t(plan.nodes()));
  for (auto& c : cell) c = std::int64_t(random()) * 8 - (std::int64_t(1) << 33);
  std::vector<double> answer(sum.size(), 1.0), multiplier(sum.size()), expected(sum.size());
  one_or_two_steps(plan, two_steps, cell.data(), sum.data(), [&](const LevelSums& sums) {
    all_items(LevelMultiplierPass<double>{sums, answer.data(), sum.data(), multiplier.data()});
  });
  by_definition(plan, [&](int level, int node, int below, double weight) {
    const auto finer = std::size_t(below);
    expected[std::size_t(node)] += weight * (level == 0 ? double(cell[finer]) : expected[finer]);
  });
  // In a plane, the constant hat along the axis that it has not counts two ends of one cell.
  const double ends = plan.all.level[0].nodes[1] == 1 ? 2 : 1;
  for (std::size_t n = 0; n < sum.size(); ++n) {
    CAPTURE(n);
    CHECK(std::fabs(double(sum[n]) - ends * expected[n]) < 9.0 * double(cell.size()));
    CHECK(multiplier[n] == std::max(0.0, double(sum[n])));
  }
}

TEST_CASE("any number of threads that share a node add up the same terms") {
  const LevelPlan plan = some_boxes();
  std::mt19937 random(3);
  std::vector<std::int64_t> cell(std::size_t(plan.cells())), sum(std::size_t(plan.nodes()));
  for (auto& c : cell) c = std::int64_t(random()) - (std::int64_t(1) << 31);
  const std::vector<double> answer(sum.size(), 1.0);
  one_or_two_steps(plan, false, cell.data(), sum.data(), [&](const LevelSums& sums) {
    const LevelMultiplierPass<double> pass{sums, answer.data(), sum.data(), nullptr};
    for (int i = 0; i < pass.items(); ++i) {
      const std::int64_t whole = pass.part(i, 0, 1);
      for (const int of : {2, 8, 32, 256, 1024}) {
        std::int64_t together = 0;
        for (int lane = 0; lane < of; ++lane) together += pass.part(i, lane, of);
        CAPTURE(i, of);
        CHECK(together == whole);
      }
    }
  });
}

TEST_CASE("a node is off where a finer one under its hat is, from the cells and from level 1") {
  const LevelPlan plan = some_boxes();
  const bool two_steps = GENERATE(false, true);
  const unsigned closed = GENERATE(0x3fu, 0x3eu, 0x1fu);  // all, but for the low x or the high z
  std::vector<std::int64_t> cell(std::size_t(plan.cells()), std::int64_t(64) << 20),
      full(std::size_t(plan.nodes()));
  cell[std::size_t(cells_of(plan).at(plan.grid.cells[0] - 1, 0, plan.grid.cells[2] / 3))] = -1;
  std::vector<double> answer(full.size());
  std::vector<int> walls(full.size());
  one_or_two_steps(plan, two_steps, cell.data(), full.data(), [&](const LevelSums& sums) {
    all_items(LevelNodePass<double>{sums, closed, 1.0, full.data(), answer.data(), walls.data()});
  });
  std::vector<int> off(full.size()), against(full.size());
  for (int n = 0; n < plan.all.level[0].size(); ++n) {
    const GridPlace at = plan.all.level[0].place(n);
    for (int k = 0; k < 3; ++k) {
      if (plan.all.level[0].nodes[k] == 1) continue;
      const bool low = at[k] == 0, high = at[k] == plan.grid.cells[k];
      if ((low && !(closed >> 2 * k & 1)) || (high && !(closed >> 2 * k & 2)))
        off[std::size_t(n)] = 1;
      if (low || high) against[std::size_t(n)] |= 1 << k;
    }
  }
  by_definition(plan, [&](int level, int node, int below, double) {
    const auto n = std::size_t(node), finer = std::size_t(below);
    off[n] |= level == 0 ? cell[finer] < 0 : off[finer];
    if (level > 0) against[n] |= against[finer];
  });
  int on = 0;
  for (std::size_t n = 0; n < full.size(); ++n) {
    CAPTURE(n);
    CHECK((full[n] < 0) == (off[n] != 0));
    CHECK((answer[n] == 0) == (off[n] != 0));
    CHECK(walls[n] == (off[n] ? 0 : against[n]));
    on += !off[n];
  }
  CHECK(on > 0);
}
