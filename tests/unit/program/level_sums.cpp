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
                        "gravity: [0, 0, 0]\n"  // no depth limits the levels
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
/// Cells, and what the passes over bricks make of them for the corners.
struct Sums {
  LevelPlan plan;
  std::vector<std::int64_t> cell = std::vector<std::int64_t>(std::size_t(plan.cells()));
  std::vector<std::int64_t> corner = std::vector<std::int64_t>(std::size_t(plan.bricks() * 8));

  template <class Pass>
  void fill_corners() {
    Pass pass{};
    pass.grid = plan.grid;
    pass.corner = corner.data();
    for (int n = 0; n < plan.grid.bricks(); ++n)
      for (int which = 0; which < Pass::brick_corners; ++which) {
        auto sum = pass.share(which, 0, 0);
        for (int k = 0; k < Pass::brick_cells; ++k)
          if (const GridPlace c = pass.cell(pass.brick(n), k); plan.grid.has(c))
            sum += pass.share(which, k, cell[std::size_t(plan.grid.at(c))]);
        pass.finish_corner(pass.brick(n), which, sum);
      }
  }
  template <template <class, int> class Pass>
  LevelSums make() {
    plan.all.level[0].nodes[1] == 1 ? fill_corners<Pass<double, 2>>()
                                    : fill_corners<Pass<double, 3>>();
    LevelSums sums{plan.all, {cells_of(plan), true, cell.data()}, {{}, false, corner.data()}};
    for (int k = 0; k < 3; ++k) sums.corners.grid.nodes[k] = 2 * plan.grid.bricks(k);
    return sums;
  }
};
template <class Pass>
void all_items(const Pass& pass) {
  for (int i = 0; i < pass.items(); ++i) pass.finish(i, pass.part(i, 0, 1));
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

TEST_CASE("multipliers are the sums of the hats' definition, 0 where they are below it") {
  Sums sums{some_boxes()};
  const LevelPlan& plan = sums.plan;
  REQUIRE(plan.all.count > 2);
  std::mt19937 random(7);
  for (auto& c : sums.cell) c = std::int64_t(random()) * 8 - (std::int64_t(1) << 33);
  const auto nodes = std::size_t(plan.nodes());
  std::vector<double> answer(nodes, 1.0), multiplier(nodes), expected(nodes);
  all_items(
      LevelMultiplierPass<double>{sums.make<LevelSumPass>(), answer.data(), multiplier.data()});
  by_definition(plan, [&](int level, int node, int below, double weight) {
    const auto finer = std::size_t(below);
    expected[std::size_t(node)] +=
        weight * (level == 0 ? double(sums.cell[finer]) : expected[finer]);
  });
  // In a plane, the constant hat along the axis that it has not counts two ends of one cell.
  const double ends = plan.all.level[0].nodes[1] == 1 ? 2 : 1;
  int above = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    CAPTURE(n);
    CHECK(std::fabs(multiplier[n] - std::max(0.0, ends * expected[n])) <
          9.0 * double(sums.cell.size()));
    above += multiplier[n] > 0;
  }
  CHECK(above > 0);
}

TEST_CASE("any number of threads that share a node add up the same terms") {
  Sums sums{some_boxes()};
  std::mt19937 random(3);
  for (auto& c : sums.cell) c = std::int64_t(random()) - (std::int64_t(1) << 31);
  const std::vector<double> answer(std::size_t(sums.plan.nodes()), 1.0);
  const LevelMultiplierPass<double> pass{sums.make<LevelSumPass>(), answer.data(), nullptr};
  for (int i = 0; i < pass.items(); ++i) {
    const std::int64_t whole = pass.part(i, 0, 1);
    for (const int of : {2, 8, 32, 256, 1024}) {
      std::int64_t together = 0;
      for (int lane = 0; lane < of; ++lane) together += pass.part(i, lane, of);
      CAPTURE(i, of);
      CHECK(together == whole);
    }
  }
}

TEST_CASE("a node is off where a finer one under its hat is, and knows the walls of those") {
  Sums sums{some_boxes()};
  const LevelPlan& plan = sums.plan;
  const unsigned closed = GENERATE(0x3fu, 0x3eu, 0x1fu);  // all, but for the low x or the high z
  std::fill(sums.cell.begin(), sums.cell.end(), std::int64_t(64) << 20);
  sums.cell[std::size_t(cells_of(plan).at(plan.grid.cells[0] - 1, 0, plan.grid.cells[2] / 3))] = -1;
  const auto nodes = std::size_t(plan.nodes());
  std::vector<double> answer(nodes);
  std::vector<int> walls(nodes), off(nodes), against(nodes);
  all_items(
      LevelNodePass<double>{sums.make<LevelHomePass>(), closed, 1.0, answer.data(), walls.data()});
  for (int n = 0; n < plan.all.level[0].size(); ++n) {
    const GridPlace at = plan.all.level[0].place(n);
    for (int k = 0; k < 3; ++k) {
      if (plan.all.level[0].nodes[k] == 1) continue;
      const bool low = at[k] == 0, high = at[k] == plan.grid.cells[k];
      if ((low && !(closed >> 2 * k & 1)) || (high && !(closed >> 2 * k & 2)))
        off[std::size_t(n)] = 1;
      against[std::size_t(n)] |= (int(low) | int(high) << 1) << 2 * k;
    }
  }
  by_definition(plan, [&](int level, int node, int below, double) {
    const auto n = std::size_t(node), finer = std::size_t(below);
    off[n] |= level == 0 ? sums.cell[finer] < 0 : off[finer];
    if (level > 0) against[n] |= against[finer];
  });
  int on = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    CAPTURE(n);
    CHECK((answer[n] == 0) == (off[n] != 0));
    CHECK(walls[n] == (off[n] ? 0 : against[n]));
    on += !off[n];
  }
  CHECK(on > 0);
}

TEST_CASE("a cell knows the walls of all nodes around it, level by level") {
  Sums sums{some_boxes()};
  const LevelPlan& plan = sums.plan;
  const LevelHierarchy& all = plan.all;
  std::mt19937 random(11);
  std::vector<int> walls(std::size_t(plan.nodes())), reach(walls.size()),
      count(sums.cell.size(), 9);
  for (int n = 0; n < int(walls.size()); ++n) {  // of some nodes those under the hat, as if off
    const int l = all.of(n);
    const GridPlace at = all.level[l].place(n - all.level[l].first);
    for (int k = 0; k < 3; ++k) walls[std::size_t(n)] |= int(all.ends(l, k, at[k])) << 2 * k;
    if (random() % 4) walls[std::size_t(n)] = 0;
  }
  const LevelReachPass reached{all, walls.data(), reach.data()};
  all_items(reached);
  std::vector<Vec4<double>> factor(count.size());
  const LevelFactorPass<double> pass{all,          plan.grid,    1.0,          {1.0, 1.0, 1.0},
                                     count.data(), walls.data(), reach.data(), factor.data()};
  for (int c = 0; c < plan.grid.size(); ++c) {
    pass(c);
    // By definition: the corners, then of each level the nodes whose hats overlap with those.
    const GridPlace cell = plan.grid.place(c);
    std::vector<GridPlace> around;
    for (int m = 0; m < 8; ++m)
      around.push_back({{cell[0] + (m & 1), cell[1] + (m >> 1 & 1), cell[2] + (m >> 2)}});
    int expected = 0;
    for (int l = 0; l < all.count; ++l) {
      std::vector<GridPlace> next;
      for (int n = 0; n < all.level[l].size(); ++n) {
        const GridPlace at = all.level[l].place(n);
        bool there = false;
        for (const GridPlace& finer : around) {
          bool overlaps = true;
          for (int k = 0; k < 3; ++k) {
            const bool one = all.level[l].nodes[k] == 1;
            overlaps = overlaps &&
                       (one || (l == 0 ? at[k] == finer[k] : std::abs(2 * at[k] - finer[k]) < 3));
          }
          there = there || overlaps;
        }
        if (!there) continue;
        next.push_back(at);
        expected |= walls[std::size_t(all.level[l].first + n)];
      }
      around = next;
    }
    CAPTURE(c);
    CHECK(int(factor[std::size_t(c)].w) == expected);
  }
}
