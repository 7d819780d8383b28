// Ranks as threads of one process: several of them make the bits of one.
#include <algorithm>
#include <numeric>

#include "lib/exec/cpu/cpu_solver.h"
#include "lib/exec/ranks/slabs.h"
#include "lib/program/rank_plan.h"
#include "tests/support/rank_runs.h"

namespace pbf::ranks_test {

using namespace test;
TEST_CASE("several ranks give the bits of one: state, readings, measurements, snapshots",
          "[slow]") {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
  };
  for (const Case& of : std::vector<Case>{
           {"configs/minimal", {"fluid.spacing=0.04"}},
           {"configs/minimal",
            {"fluid.spacing=0.04", "viscosity.xsph=0.1", "vorticity.epsilon=1", "tensile={}",
             "precision=double"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.substeps=3", "viscosity.xsph=0.1"}},
           {"configs/minimal",
            {"fluid.spacing=0.04", "viscosity.kinematic=0.05", "domain.friction=1",
             "domain.loads=true"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.kernels=paper"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.method=chebyshev"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.tolerance=1e-3"}},
           {"configs/dam_break_2d", {"fluid.spacing=0.016", "vorticity.epsilon=1"}},
           {"tests/regression/frozen/obstacles", {}},
           {"tests/regression/frozen/obstacles", {"time.order=1"}},
           {"tests/regression/frozen/meshes", {}},
           {"tests/regression/frozen/motions", {"viscosity.xsph=0.1", "gauges=[]"}},
       }) {
    const RankScene m(of.scene, of.set);
    const int updates = m.scene.dimensions == 2 ? 300 : 60;  // 300: the cuts move
    const std::vector<Seen> one = on_one(m, updates);
    for (const int ranks : {2, 3, 4, 8}) {
      CAPTURE(of.scene, of.set, ranks);
      const std::vector<Seen> all = on_ranks(m, ranks, updates);
      for (std::size_t k = 0; k < one.size(); ++k) {
        CAPTURE(k);
        check_same(one[k], all[k], m.scene);
      }
    }
  }
}

TEST_CASE("several ranks name the update and the stage of a fault as one does", "[slow]") {
  const RankScene m("configs/minimal", {"fluid.spacing=0.04"});
  const StageLimits limits{0.5 / m.scene.h(), 1e300, 1000};
  const auto found = [&](Solver& s) {
    std::optional<StageEvent> event;
    s.step(5);
    while (!event && s.updates() < 200) event = s.inspection()->step_checked(limits);
    return std::pair(s.state(), event);
  };
  const auto one = found(*make_cpu_solver(m.scene, m.plan, m.particles));
  REQUIRE(one.second);
  run_thread_ranks(3, [&](Communicator& c) {
    RankedSolver s(c, m.scene, m.plan, m.part(c));
    if (c.rank() != 0) return s.serve();
    const auto all = found(s);
    REQUIRE(all.second);
    CHECK(all.second->update == one.second->update);
    CHECK(all.second->stage == one.second->stage);
    CHECK(all.second->id == one.second->id);
    CHECK(all.first.position == one.first.position);
    CHECK(all.first.velocity == one.first.velocity);
  });
}

TEST_CASE("several ranks with levels give the bits of one", "[slow]") {
  for (const auto& [scene, set] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"configs/minimal", {"fluid.spacing=0.02", "solver.levels=on", "domain.loads=true"}},
           {"configs/dam_break_2d",
            {"fluid.spacing=0.008", "solver.levels=on", "solver.iterations=2",
             "domain.open=[x_max]"}}}) {
    const RankScene m(scene, set);
    CAPTURE(scene);
    const std::vector<Seen> one = on_one(m, 20), two = on_ranks(m, 2, 20);
    for (std::size_t k = 0; k < one.size(); ++k) check_same(one[k], two[k], m.scene);
  }
}

TEST_CASE("ranks send as many messages as the plan says, and no more bytes") {
  for (const std::vector<std::string>& set : std::vector<std::vector<std::string>>{
           {}, {"viscosity.xsph=0.1"}, {"solver.iterations=2", "solver.substeps=3"}}) {
    CAPTURE(set);
    std::vector<std::string> all = set;
    all.insert(all.end(), {"fluid.spacing=0.04", "solver.hyperviscosity=0"});
    const RankScene m("configs/minimal", all);
    const RankPlan plan = plan_ranks(m.plan, m.scene, 2);
    run_thread_ranks(2, [&](Communicator& c) {
      RankedSolver s(c, m.scene, m.plan, m.part(c));
      if (c.rank() != 0) return s.serve();
      s.step(10);
      const Traffic before = c.sent;
      s.step(20);
      CHECK(c.sent.messages - before.messages == 20 * plan.messages());
      CHECK(std::ranges::any_of(s.info().stages,
                                [](const StageTime& t) { return t.name == "exchange"; }));
      const std::int64_t bytes = c.sent.bytes - before.bytes;
      CHECK(bytes > 0);
      // Rows that change ranks are sent whole, and few of the particles do.
      CHECK(double(bytes) < 1.2 * 20 * double(plan.bytes_per_ghost * plan.ghosts));
    });
  }
}

TEST_CASE("the plan of ranks: one message per exchange, as counted by hand for 4 iterations") {
  const RankScene m("configs/minimal", {"solver.hyperviscosity=0", "time.order=1"});
  const RankPlan plan = plan_ranks(m.plan, m.scene, 8);
  // 4 times (x, lambda) for delta, and 3 times x* for lambda. Positions come with the rows.
  CHECK(plan.exchanges == 4 + 3);
  CHECK(plan.sorts == 1);
  CHECK(plan.bytes_per_ghost == 7 * 16 + 16 + 16 + 4 + 4);  // x, v, id, bin
}

TEST_CASE("a rank on a device has memory for its share of the particles, not for all") {
  const RankScene m("configs/dam_break_2d", {"fluid.spacing=0.001", "domain.max=[1.6, 0.001, 1]",
                                             "bodies.0.max=[0.4, 0.001, 0.8]", "backend=cuda"});
  const Plan part = plan_of_rank(m.plan, scene_of_rank(m.plan, m.scene, 4));
  CHECK(part.particles == m.plan.particles);
  CHECK(double(part.memory.device_arrays) < 0.45 * double(m.plan.memory.device_arrays));
}

TEST_CASE("a rank adds in the order of one process: both take turns, or neither") {
  for (const char* precision : {"float", "double"}) {
    const RankScene m("configs/minimal", {"backend=cuda", std::string("precision=") + precision});
    CHECK(m.plan.turns == (precision == std::string("float")));
    CHECK(plan_of_rank(m.plan, scene_of_rank(m.plan, m.scene, 2)).turns == m.plan.turns);
  }
}

TEST_CASE("a scene with periodic axes is refused on several ranks by its key") {
  const RankScene m("configs/minimal", {"domain.periodic=[x]"});
  CHECK_THROWS_WITH(
      require_ranks(m.scene, m.plan, 2),
      Catch::Contains("cannot run on several ranks: it has periodic axes (domain.periodic)"));
}

TEST_CASE("a scene with free bodies is refused on several ranks by its key") {
  const RankScene m("configs/floating", {"fluid.spacing=0.04"});
  CHECK_THROWS_WITH(require_ranks(m.scene, m.plan, 2),
                    Catch::Contains("scene floating cannot run on several ranks: the fluid moves "
                                    "some of its obstacles (obstacles[].free)"));
  Scene fixed = m.scene;
  for (Obstacle& o : fixed.obstacles) o.free.reset();
  CHECK_NOTHROW(require_ranks(fixed, m.plan, 2));
}

TEST_CASE("slabs: particles are shared equally, and every rank has a layer") {
  std::vector<std::int64_t> in_layer(20, 100);
  const Slabs four(in_layer, 4, 1);
  for (int r = 0; r < 4; ++r) CHECK(four.high(r) - four.low(r) == 5);
  CHECK(four.owner(0) == 0);
  CHECK(four.owner(19) == 3);
  std::fill(in_layer.begin() + 1, in_layer.end(), 0);  // all in one layer
  Slabs moved = four;
  CHECK_FALSE(moved.balance(in_layer));  // no cut makes the largest share smaller
  CHECK(moved == four);
  CHECK_FALSE(moved.crowded(100));  // all are on the first rank, and cannot be elsewhere
  CHECK(moved.crowded(104));
  const Slabs one(in_layer, 20, 1);
  for (int r = 0; r < 20; ++r) CHECK(one.low(r) == r);
  CHECK_THROWS_WITH(Slabs(in_layer, 21, 1), Catch::Contains("start at most 20 ranks"));
  const Slabs bricks(std::vector<std::int64_t>(20, 1), 2, 8);
  CHECK(bricks.high(0) % 8 == 0);
  CHECK(bricks.high(1) == 20);
}

TEST_CASE("slabs: no more than 4 % of a share, or a unit of layers, goes over a cut at a time") {
  for (const int unit : {1, 8}) {
    std::vector<std::int64_t> in_layer(160, 100);
    Slabs slabs(in_layer, 4, unit);
    std::fill(in_layer.begin(), in_layer.begin() + 80, 150);
    std::fill(in_layer.begin() + 80, in_layer.end(), 50);
    int looks = 0;
    do {
      CAPTURE(unit, ++looks);
      REQUIRE(looks < 50);
      const Slabs before = slabs;
      slabs.balance(in_layer);
      for (int r = 1; r < 4; ++r) {
        const int from = std::min(before.low(r), slabs.low(r)),
                  to = std::max(before.low(r), slabs.low(r));
        CHECK(slabs.low(r) > slabs.low(r - 1));
        CHECK(slabs.low(r) % unit == 0);
        const auto moved = std::accumulate(in_layer.begin() + from, in_layer.begin() + to, 0);
        CHECK((moved <= 160 || to - from == unit));
        for (int l = slabs.low(r); l < slabs.high(r); ++l) CHECK(slabs.owner(l) == r);
      }
    } while (slabs.unfinished());
    CHECK(looks > 2);
    CHECK(slabs.crowded((4000 + 150 * unit) * 26 / 25));  // ranks have about 4000 each now
  }
}

TEST_CASE("several ranks of which one has no ghosts measure what one does, after any reading") {
  const RankScene m(
      "configs/minimal",
      {"fluid.spacing=0.04", R"(bodies=[{"shape":"block","min":[0,0,0],"max":[0.8,0.2,0.4]},)"
                             R"({"shape":"block","min":[1.2,0,0],"max":[1.6,0.2,0.4]}])"});
  const auto measured = [](Solver& s) {
    std::vector<double> all;
    s.step(3);
    for (int k = 0; k < 2; ++k) {
      all.push_back(s.diagnose().compression_max);
      all.push_back(s.state(StateOf::present).position[0]);
    }
    return all;
  };
  const auto one = measured(*make_cpu_solver(m.scene, m.plan, m.particles));
  run_thread_ranks(3, [&](Communicator& c) {
    RankedSolver s(c, m.scene, m.plan, m.part(c));
    if (c.rank() != 0) return s.serve();
    CHECK(measured(s) == one);
  });
}

TEST_CASE("four slabs of a dam break stay equal within 10 %", "[slow]") {
  const RankScene m("configs/dam_break_2d", {"fluid.spacing=0.005"});
  const auto solver = make_cpu_solver(m.scene, m.plan, m.particles);
  const int axis = m.plan.axes.of[2];
  Slabs slabs;
  int cuts = 0;
  for (int k = 0; k < 12; ++k) {
    std::vector<std::int64_t> in_layer(std::size_t(m.plan.cells[2]));
    const SolverState s = solver->state(StateOf::positions);
    for (std::size_t i = std::size_t(axis); i < s.position.size(); i += 3) {
      const double layer = std::max(0.0, s.position[i] / m.plan.cell_edge);
      ++in_layer[std::min(std::size_t(layer), in_layer.size() - 1)];
    }
    if (k == 0)
      slabs = Slabs(in_layer, 4, 1);
    else
      do cuts += slabs.balance(in_layer);
      while (slabs.unfinished());
    for (int r = 0; r < 4; ++r) {
      const auto own = std::accumulate(in_layer.begin() + slabs.low(r),
                                       in_layer.begin() + slabs.high(r), std::int64_t(0));
      CAPTURE(k, r);
      CHECK(double(own) < 1.1 * double(m.plan.particles) / 4);
    }
    solver->step(64);
  }
  CHECK(cuts > 3);
}

TEST_CASE("an error of one rank ends all, and is told with its rank") {
  CHECK_THROWS_WITH(run_thread_ranks(3,
                                     [](Communicator& c) {
                                       if (c.rank() == 2) throw std::runtime_error("no memory");
                                       std::vector<std::int64_t> one(1);
                                       for (;;) c.sum(one);
                                     }),
                    Catch::Contains("no memory"));
}

}  // namespace pbf::ranks_test
