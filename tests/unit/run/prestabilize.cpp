// Starts relieved of their compression: what that does to the energy, and what it leaves alone.
#include "lib/run/prestabilize.h"
#include "lib/exec/make_solver.h"
#include "lib/run/emit.h"
#include "lib/run/start.h"

#include <cmath>
#include <filesystem>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

std::unique_ptr<Solver> start(const Scene& s, const std::string& dir = ".") {
  Start start = prepare(s, dir);
  return solver_of(start);
}

std::unique_ptr<Solver> as_given(Scene s, const std::string& dir = ".") {
  s.solver.prestabilize = false;
  return start(s, dir);
}

struct Energy {
  double kinetic = 0, height = 0;  ///< J; the potential energy above the lower faces
  double sum() const { return kinetic + height; }
};

/// From the particles alone.
Energy energy_of(Solver& solver, const Scene& s, double mass) {
  const Snapshot snap = solver.download({"velocity"}, ScalarType::f64).get();
  const auto x = snap.find("position")->as<double>(), v = snap.find("velocity")->as<double>();
  Energy e;
  for (std::size_t k = 0; k < x.size(); ++k) {
    e.kinetic += 0.5 * mass * v[k] * v[k];
    e.height -= mass * s.gravity[k % 3] * (x[k] - s.domain.min[k % 3]);
  }
  return e;
}

/// Largest rise of the energy in `time` s, as a share of the energy at the start.
double rise(Solver& solver, const Scene& s, double time) {
  const Energy first = energy_of(solver, s, s.particle_mass());
  double most = 0;
  const int updates = int(std::lround(time / s.time.step)), every = std::max(1, updates / 20);
  for (int u = 0; u < updates; u += every) {
    solver.step(every);
    most = std::max(most, energy_of(solver, s, s.particle_mass()).sum() - first.sum());
  }
  return most / first.sum();
}

bool same_particles(Solver& a, Solver& b) {
  const SolverState x = a.state(), y = b.state();
  return x.position == y.position && x.velocity == y.velocity && x.id == y.id &&
         x.updates == y.updates;
}

/// A ball of the lattice in free space, every coordinate off its place by up to a fifth of d.
std::string jittered_ball(const Folder& folder) {
  std::mt19937 gen(7);
  folder.write("ball.csv", scene_test::jittered_ball(0.2, gen));
  return folder.path.string();
}

Scene ball(const std::vector<std::string>& overrides) {
  Scene s = shipped("extreme/drop", overrides);
  s.bodies[0].shape = Shape::file;
  s.bodies[0].path = "ball.csv";
  s.bodies[0].velocity = {1, 0, 0};
  return s;
}

}  // namespace

TEST_CASE(
    "prestabilize: the shorter the step, the less energy a start of the lattice adds, in every "
    "shipped scene") {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
  };
  for (const Case& c :
       {Case{"tank_at_rest", {"fluid.spacing=0.04"}}, Case{"dam_break", {"fluid.spacing=0.05"}},
        Case{"double_dam_break", {"fluid.spacing=0.05"}},
        Case{"sphere_drop", {"fluid.spacing=0.05"}}, Case{"dam_break_2d", {"fluid.spacing=0.016"}},
        Case{"minimal", {"fluid.spacing=0.04"}}, Case{"stiff/pool", {}},
        Case{"stiff/column", {"fluid.spacing=0.04"}}}) {
    double unrelieved = 0;
    for (const char* step : {"1e-3", "1e-4", "1e-5"}) {
      CAPTURE(c.scene, step);
      std::vector<std::string> set = c.set;
      set.push_back(std::string("time.step=") + step);
      const Scene s = shipped(c.scene, set);
      CHECK(rise(*start(s), s, 1e-3) < 2e-4);
      unrelieved = rise(*as_given(s), s, 1e-3);
    }
    CHECK(unrelieved > 1e-3);  // with the shortest step: there is something to take out
  }
}

TEST_CASE("prestabilize: a ball that starts jittered gains less than 1 % of energy") {
  const Folder folder;
  const std::string dir = jittered_ball(folder);
  for (const std::vector<std::string>& set : {std::vector<std::string>{},
                                              {"solver.method=chebyshev"},
                                              {"solver.substeps=4"},
                                              {"solver.method=chebyshev", "solver.substeps=4"},
                                              {"time.step=0.0005"},
                                              {"precision=double"}}) {
    CAPTURE(set);
    const Scene s = ball(set);
    CHECK(rise(*start(s, dir), s, 0.2) < 0.001);
    CHECK(rise(*as_given(s, dir), s, 0.2) > 0.01);
  }
}

TEST_CASE(
    "prestabilize: velocities, ids and the number of updates stay, on any number of threads") {
  const Folder folder;
  const std::string dir = jittered_ball(folder);
  Scene s = ball({});
  s.bodies.push_back({});
  s.bodies[1].min = {1.5, 0, 0};
  s.bodies[1].max = {2, 0.5, 0.5};
  s.bodies[1].velocity = {0.1, -0.2, 1.0 / 3};
  const auto given = as_given(s, dir), one = start(s, dir);
  const auto velocity = [](Solver& solver) {
    const Snapshot snap = solver.download({"velocity"}, ScalarType::f32).get();
    const auto v = snap.find("velocity")->as<float>();
    return std::vector<float>(v.begin(), v.end());
  };
  CHECK(velocity(*given) == velocity(*one));
  CHECK(given->state().position != one->state().position);
  CHECK(one->updates() == 0);
  for (const int threads : {2, 3}) {
    s.threads = threads;
    CHECK(same_particles(*start(s, dir), *one));
  }
}

TEST_CASE("prestabilize: a start without harmful compression keeps its bits") {
  for (const char* name : {"extreme/drop", "stiff/thin", "sphere_drop"}) {
    CAPTURE(name);
    Scene s = shipped(name, {"fluid.spacing=0.05"});
    if (s.name == "sphere_drop") s.solver.iterations = 0;  // nothing would part the particles
    const Plan plan = make_plan(s, count_particles(s, "."));
    const auto solver = as_given(s);
    const Prestabilized p = prestabilize(*solver, s, plan);
    CHECK(p.steps == 0);
    CHECK(prestabilized_text(p).empty());
    CHECK(same_particles(*solver, *as_given(s)));
  }
}

TEST_CASE("prestabilize: whatever the scene asks of an update, the start is relieved") {
  for (const char* set :
       {"solver.tolerance=0.001", "solver.substeps=5", "solver.iterations=1",
        "solver.method=chebyshev", "solver.velocity_damping=0.5", "solver.boundary=clamp",
        "solver.speed_limit=0.001", "domain.open=[x_max, z_max]", "tensile={k: 0.1}",
        "vorticity={epsilon: 10}", "solver.constraint=two_sided", "solver.kernels=paper",
        "time.adaptive={}", "precision=double", "solver.wall_margin=0.01"}) {
    CAPTURE(set);
    Scene s = shipped("stiff/pool", {"time.step=1e-3", set});
    // A lattice that is too narrow by 1 %, with room above.
    s.bodies[0].max = {0.397, 0.397, 0.6};
    s.fluid.spacing = 0.0495;
    s.fluid.mass = 1000 * 0.05 * 0.05 * 0.05;
    const Plan plan = make_plan(s, count_particles(s, "."));
    const auto solver = as_given(s);
    const Prestabilized p = prestabilize(*solver, s, plan);
    CHECK(p.steps > 0);
    CHECK(p.relieved());
    CHECK(p.moved > 0);
    CHECK(p.after.compression_mean < 0.01 * p.before.compression_mean);
    // One more moves no particle by more than 0.005 h; nothing has a velocity.
    const std::vector<double> before = solver->state().position;
    solver->step(1, {.without_time = 1.0});
    const std::vector<double> after = solver->state().position;
    double most = 0;
    for (std::size_t k = 0; k < after.size(); ++k)
      most = std::max(most, std::fabs(after[k] - before[k]));
    CHECK(most < 5e-3);
    CHECK(solver->diagnose().speed_max == 0);
  }
}

TEST_CASE("prestabilize: a two-sided scene starts like a one-sided one, pulled nowhere") {
  const Folder folder;
  const std::string dir = jittered_ball(folder);
  const auto one = start(ball({}), dir), two = start(ball({"solver.constraint=two_sided"}), dir);
  CHECK(same_particles(*one, *two));
}

TEST_CASE("prestabilize: a particle that crosses a periodic face has not moved through the box") {
  const Scene s = parse(
      "domain: {min: [0, 0, 0], max: [1, 1, 1], periodic: [x, y, z]}\n"
      "fluid: {spacing: 0.1}\n"
      "bodies: [{shape: random_box, min: [0, 0, 0], max: [1, 1, 1], count: 1000}]\n"
      "gravity: [0, 0, 0]\ntime: {step: 0.01, end: 1}\n");
  Start first = prepare(s, ".");
  const auto solver = make_solver(s, first.plan, first.particles);
  const std::vector<double> from = solver->state(StateOf::positions).position;
  const Prestabilized p = prestabilize(*solver, s, first.plan);
  const std::vector<double> to = solver->state(StateOf::positions).position;
  int crossed = 0;
  for (std::size_t k = 0; k < from.size(); ++k) crossed += std::fabs(to[k] - from[k]) > 2.5;  // h
  CHECK(crossed > 20);
  CHECK(p.moved > 0.3);
  CHECK(p.moved < 4);  // spacings; the box has 10
}

TEST_CASE("prestabilize: an over-full box ends it, and the text says that there is no room") {
  const Scene s = shipped("stiff/overfull", {"bodies[0].count=3000"});
  const Plan plan = make_plan(s, 3000);
  const auto solver = as_given(s);
  int lines = 0;
  const Prestabilized p = prestabilize(*solver, s, plan, [&](const std::string&) { ++lines; });
  CHECK_FALSE(p.relieved());
  CHECK(p.steps < 64);
  CHECK(lines > 0);
  CHECK(contains(prestabilized_text(p), "is there room for all of them?"));
  const Diagnostics m = solver->diagnose();
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
  CHECK(m.kinetic_energy == 0);
}

TEST_CASE("prestabilize: a mean that rises while the largest falls is explained, in one line") {
  Prestabilized p;
  CHECK(prestabilized_text(p).empty());
  p.steps = 1;
  p.before.compression_mean = 2e-5;
  p.before.compression_max = 0.005;
  p.after.compression_mean = 2.5e-5;
  p.after.compression_max = 0.0007;
  p.moved = 0.006;
  const std::string begin =
      "start: compression mean 0.002 %, largest 0.5 %; after 1 step without time "
      "(solver.prestabilize) mean ";
  const std::string end = ", largest 0.07 %; no particle has moved by more than 0.006 spacings";
  CHECK(prestabilized_text(p) == begin + "0.0025 % (spread over more particles now)" + end);
  p.after.compression_mean = 1e-5;
  CHECK(prestabilized_text(p) == begin + "0.001 %" + end);
  // In a run: the edges of a block.
  const Scene s = shipped("dam_break", {"fluid.spacing=0.03"});
  const std::int64_t n = count_particles(s, "");
  const Plan plan = make_plan(s, n);
  const auto solver = make_solver(s, plan, emit_particles(s, ""));
  const Prestabilized done = prestabilize(*solver, s, plan);
  CHECK(done.after.compression_mean > done.before.compression_mean);
  CHECK(done.after.compression_max < 0.2 * done.before.compression_max);
}

}  // namespace pbf::scene_test
