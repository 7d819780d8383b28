// Several ranks that work as on GPUs, on the CPU: they give the bits of one.
#include "tests/support/watched_ranks.h"

#include <map>
#include <mutex>

#include "lib/program/rank_plan.h"
#include "lib/solver/step_solver.h"
#include "tests/support/rank_runs.h"

namespace pbf::watched_ranks_test {
namespace {

using test::RankScene, test::RankWatch, test::WatchedExec;

/// A scene whose levels no depth limits.
struct Made : RankScene {
  Made(const std::string& name, const std::vector<std::string>& set) : RankScene(name, set) {
    StartNeighbors start;
    start.of_files = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};
    plan = make_plan(scene, plan.particles, start);
  }
};

struct Ran {
  std::map<std::int64_t, std::vector<double>> particles;  ///< position and velocity by id
  std::vector<double> loads;
  bool operator==(const Ran&) const = default;
};

void add(Solver& s, Ran& to) {
  to.loads = s.readings(Series::measures, Interval::ends);
  const SolverState now = s.state(StateOf::present);
  for (std::size_t k = 0; k < now.id.size(); ++k) {
    std::vector<double>& row = to.particles[now.id[k]];
    for (const auto* of : {&now.position, &now.velocity})
      row.insert(row.end(), of->begin() + std::ptrdiff_t(3 * k),
                 of->begin() + std::ptrdiff_t(3 * k + 3));
  }
}
Ran alone(const Made& m, int updates) {
  const auto solver = make_solver(m.scene, m.plan, m.particles);
  solver->step(updates);
  Ran ran;
  add(*solver, ran);
  return ran;
}
/// all: what each rank has seen.
Ran watched(const Made& m, int ranks, int updates, std::vector<RankWatch>& all,
            const std::string& forget = "", bool looks = true) {
  const Scene scene = scene_of_rank(m.plan, m.scene, ranks);
  const Plan plan = plan_of_rank(m.plan, scene);
  all.assign(std::size_t(ranks), {.forget = forget, .looks = looks});
  std::mutex mutex;
  Ran ran;
  run_thread_ranks(ranks, [&](Communicator& c) {
    StepSolver<float, WatchedExec> solver(scene, plan, m.part(c), all[std::size_t(c.rank())], c);
    solver.step(updates, {});
    Ran mine;
    add(solver, mine);
    const std::lock_guard lock(mutex);
    ran.particles.merge(mine.particles);
    ran.loads = mine.loads;
  });
  return ran;
}

}  // namespace

TEST_CASE("several ranks give the bits of one and find NaN in all copies that no exchange brings",
          "[slow]") {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
    int most_ranks = 3;
  };
  for (const Case& of : std::vector<Case>{
           {"configs/minimal", {"fluid.spacing=0.04"}},
           {"configs/minimal",
            {"fluid.spacing=0.04", "viscosity.xsph=0.1", "vorticity.epsilon=1", "tensile={}"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.substeps=3", "viscosity.xsph=0.1"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.kernels=paper"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.tolerance=1e-3"}},
           {"configs/dam_break_2d", {"fluid.spacing=0.016", "vorticity.epsilon=1"}},
           {"tests/regression/frozen/obstacles", {}},
           {"tests/regression/frozen/obstacles", {"time.order=1"}},
           {"tests/regression/frozen/meshes", {}},
           {"tests/regression/frozen/motions", {"viscosity.xsph=0.1", "gauges=[]"}},
           {"tests/regression/frozen/motions", {"viscosity.xsph=0.1", "gauges=[]", "time.order=1"}},
           // Ranks meet at bricks of 16 h here, and the sums of all cells are exchanged.
           {"configs/minimal", {"fluid.spacing=0.02", "solver.levels=on", "domain.loads=true"}, 2},
           {"configs/dam_break_2d",
            {"fluid.spacing=0.008", "solver.levels=on", "solver.iterations=2",
             "domain.open=[x_max]"},
            2},
       }) {
    const Made m(of.scene, of.set);
    const Ran one = alone(m, 60);
    for (int ranks = 2; ranks <= of.most_ranks; ++ranks) {
      CAPTURE(of.scene, of.set, ranks);
      std::vector<RankWatch> seen;
      CHECK(watched(m, ranks, 60, seen) == one);
      for (const RankWatch& w : seen) {
        CHECK(w.poisoned > 0);
        CHECK(w.has_each_own_row_once);
      }
    }
  }
}

TEST_CASE("without any one of their exchanges ranks give other bits", "[slow]") {
  struct Case {
    std::vector<std::string> set, exchanged;
  };
  for (const Case& of : std::vector<Case>{
           {{"fluid.spacing=0.05", "viscosity.xsph=0.1", "vorticity.epsilon=1", "tensile={}"},
            {"position", "velocity", "curl"}},
           {{"fluid.spacing=0.02", "solver.levels=on", "domain.loads=true", "time.order=1",
             R"(bodies=[{"shape":"block","min":[0,0,0],"max":[1.2,0.4,0.4]}])"},
            {"level cell count", "level cell sum", "level corner sum"}}}) {
    const Made m("configs/minimal", of.set);
    const Ran one = alone(m, 10);
    std::vector<RankWatch> seen;
    CHECK(watched(m, 2, 10, seen) == one);
    for (const std::string& name : of.exchanged) {
      CAPTURE(name);
      CHECK_FALSE(watched(m, 2, 10, seen, name) == one);
    }
  }
}

TEST_CASE("ranks that lose rows repeat the updates and give the bits of one", "[slow]") {
  // Slabs are one or two layers thick here, and a particle crosses one in an update.
  const Made m("configs/dam_break_2d", {"fluid.spacing=0.016"});
  std::vector<RankWatch> seen;
  CHECK(watched(m, 8, 300, seen) == alone(m, 300));
  for (const RankWatch& w : seen) CHECK(w.repeated > 0);
}

TEST_CASE("a rank that a jet fills between two regular looks at the cuts is relieved at once") {
  const Made m(
      "configs/dam_break_2d",
      {"fluid.spacing=0.008",
       R"(bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.008,0.3],"velocity":[12,0,0]}])"});
  std::vector<RankWatch> seen;
  CHECK(watched(m, 2, 50, seen) == alone(m, 50));
  for (const RankWatch& w : seen) {
    CAPTURE(w.most, m.plan.particles);
    CHECK(w.most < 1.06 * double(m.plan.particles) / 2);
  }
}

TEST_CASE("ranks make lists before the host knows for how many rows, and give the bits of one") {
  const Made m("configs/dam_break_2d", {"fluid.spacing=0.016"});
  std::vector<RankWatch> seen;
  CHECK(watched(m, 3, 50, seen, "", false) == alone(m, 50));
  for (const RankWatch& w : seen) CHECK(w.early_lists > 50);
}

TEST_CASE("rows at cuts are launched beside the others, which find NaN in what arrives meanwhile") {
  const Made m("configs/dam_break_2d", {"fluid.spacing=0.016"});
  std::vector<RankWatch> seen;
  CHECK(watched(m, 2, 4, seen) == alone(m, 4));
  for (const RankWatch& w : seen) {
    CHECK(w.split > 0);
    CHECK(w.has_each_own_row_once);
  }
}

}  // namespace pbf::watched_ranks_test
