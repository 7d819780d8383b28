// Two ranks in one process, which exchange what the declarations of passes say and find NaN in all
// other copies of each other's particles: they give the bits of one.
#include "lib/run/emit.h"
#include "lib/run/motion_files.h"
#include "lib/scene/load.h"
#include "lib/solver/step_solver.h"
#include "tests/support/catch.h"
#include "tests/support/rank_exec.h"

namespace pbf::two_ranks_test {
namespace {

struct Made {
  Scene scene;
  Particles particles;
  Plan plan, of_ranks;
  Made(const std::string& name, std::vector<std::string> set) {
    set.insert(set.end(), {"output=off", "render=off", "threads=1"});
    const std::string file = std::string(PBF_SOURCE_DIR) + "/" + name + ".yaml";
    const std::string folder = file.substr(0, file.rfind('/'));
    scene = load_scene(file, set).scene;
    read_motions(scene, folder);
    particles = emit_particles(scene, folder);
    const auto n = std::int64_t(particles.size());
    StartNeighbors start;
    start.of_files = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};  // no depth limits the levels
    plan = make_plan(scene, n, start);
    Scene counted = scene;
    counted.capacity = 2 * n;
    of_ranks = make_plan(counted, n, start);
    of_ranks.program = make_program_of<test::RankFeatures>(counted, of_ranks.shape());
  }
  Scene of_rank() const {
    Scene counted = scene;
    counted.capacity = of_ranks.capacity;
    return counted;
  }
};

using Bits = std::map<int, std::vector<float>>;

SolverState on_one(const Made& m, int updates) {
  StepSolver<float, CpuExec> solver(m.scene, m.plan, m.particles, 1);
  solver.step(updates, {});
  return solver.state(StateOf::present);
}
Bits bits_of(const SolverState& s, const Made& m) {
  Bits out;
  for (std::size_t k = 0; k < s.id.size(); ++k) {
    std::vector<float>& row = out[s.id[k]];
    for (std::size_t c = 0; c < 3; ++c)
      row.push_back(float(s.position[3 * k + std::size_t(m.plan.axes.of[c])]));
    for (std::size_t c = 0; c < 3; ++c)
      row.push_back(float(s.velocity[3 * k + std::size_t(m.plan.axes.of[c])]));
  }
  return out;
}

}  // namespace

TEST_CASE("two ranks give the bits of one, with what declarations say they exchange", "[slow]") {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
  };
  for (const Case& of : std::vector<Case>{
           {"configs/minimal", {"fluid.spacing=0.04"}},
           {"configs/minimal",
            {"fluid.spacing=0.04", "viscosity.xsph=0.1", "vorticity.epsilon=1", "tensile={}"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.substeps=3", "viscosity.xsph=0.1"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.kernels=paper"}},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.tolerance=1e-3", "threads=1"}},
           {"configs/dam_break_2d", {"fluid.spacing=0.016", "vorticity.epsilon=1"}},
           {"tests/regression/frozen/obstacles", {}},
           {"tests/regression/frozen/obstacles", {"time.order=1"}},
           {"tests/regression/frozen/motions", {"viscosity.xsph=0.1"}},
           {"tests/regression/frozen/motions", {"viscosity.xsph=0.1", "time.order=1"}},
           // Ranks meet at bricks of 16 h here, and the sums of all cells are exchanged.
           {"configs/minimal", {"fluid.spacing=0.02", "solver.levels=on", "domain.loads=true"}},
           {"configs/dam_break_2d",
            {"fluid.spacing=0.008", "solver.levels=on", "solver.iterations=2",
             "domain.open=[x_max]"}},
       }) {
    const Made m(of.scene, of.set);
    CAPTURE(of.scene, of.set);
    test::TwoRanks<float> ranks(m.of_rank(), m.of_ranks, m.particles);
    const int updates = 60;
    for (int k = 0; k < updates; ++k) ranks.step();
    const SolverState one = on_one(m, updates);
    CHECK(ranks.state() == bits_of(one, m));
    CHECK(ranks.moved > 0);
    CHECK(ranks.ghosts_at_most > 20);
    CHECK(ranks.own_at_least > 20);
    const StoredField* loads = one.find("loads");
    for (const int rank : {0, 1})
      CHECK(ranks.loads(rank) == (loads ? loads->values : std::vector<double>{}));
  }
}

TEST_CASE("without any one of their exchanges two ranks give other bits") {
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
    const SolverState one = on_one(m, 10);
    const Bits expected = bits_of(one, m);
    const StoredField* loads = one.find("loads");
    const auto same_without = [&](const std::string& name) {
      test::TwoRanks<float> ranks(m.of_rank(), m.of_ranks, m.particles, name);
      for (int k = 0; k < 10; ++k) ranks.step();
      return ranks.state() == expected && (!loads || ranks.loads(0) == loads->values);
    };
    CHECK(same_without(""));
    for (const std::string& name : of.exchanged) {
      CAPTURE(name);
      CHECK_FALSE(same_without(name));
    }
  }
}

}  // namespace pbf::two_ranks_test
