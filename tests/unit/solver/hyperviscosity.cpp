// Hyperviscosity against sums over all pairs, and when it acts.
#include <cmath>

#include "lib/exec/make_solver.h"
#include "lib/program/hyperviscosity.h"
#include "lib/run/emit.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

const std::string kFilled =
    "domain: {min: [0, 0, 0], max: [0.8, 0.6, 1]}\n"
    "fluid: {spacing: 0.1}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.5]}]\n"
    "time: {step: 0.02, end: 1, order: 2}\n";  // dt sqrt(g/h) = 0.14: every 4 updates

struct Pool {
  Scene scene;
  Plan plan;
  std::unique_ptr<Solver> solver;
  Pool(const std::string& yaml, std::vector<std::string> set) {
    set.push_back("threads=1");
    scene = scene_test::parse(yaml, std::move(set));
    Particles particles = emit_particles(scene, ".");
    plan = make_plan(scene, std::int64_t(particles.size()));
    solver = make_solver(scene, plan, std::move(particles));
  }
  SolverState after(int updates) {
    solver->step(updates);
    return solver->state();
  }
};

constexpr double kPi = 3.14159265358979323846;
using Rows = std::vector<double>;  // three numbers per particle

/// sum_j vol W_ij (u_j - u_i) over all pairs; x in h. W is Spiky.
Rows laplacian(const Rows& x, const Rows& u, double vol, int dimensions) {
  const double norm = dimensions == 3 ? 15 / kPi : 10 / kPi;
  Rows out(u.size());
  for (std::size_t i = 0; i < x.size(); i += 3)
    for (std::size_t j = 0; j < x.size(); j += 3) {
      const double q = std::hypot(x[i] - x[j], x[i + 1] - x[j + 1], x[i + 2] - x[j + 2]);
      if (q >= 1) continue;
      for (std::size_t k = 0; k < 3; ++k)
        out[i + k] += vol * norm * std::pow(1 - q, 3) * (u[j + k] - u[i + k]);
    }
  return out;
}

bool same(const SolverState& a, const SolverState& b) {
  return a.position == b.position && a.velocity == b.velocity && a.id == b.id;
}

}  // namespace

TEST_CASE("hyperviscosity takes c L f L v from the velocities, and no momentum") {
  for (const char* dimensions : {"3", "2"}) {
    CAPTURE(dimensions);
    std::vector<std::string> set{"precision=double", std::string("dimensions=") + dimensions};
    if (*dimensions == '2')
      set.insert(set.end(), {"domain.min=[0, 0]", "domain.max=[0.8, 1]", "bodies[0].min=[0, 0]",
                             "bodies[0].max=[0.4, 0.5]"});
    Pool with(kFilled, set);
    set.push_back("solver.hyperviscosity=0");
    Pool without(kFilled, set);
    REQUIRE(with.plan.hyperviscosity.every == 4);
    REQUIRE(without.plan.hyperviscosity.every == 0);
    CHECK(same(with.after(3), without.after(3)));
    const SolverState a = with.after(1), b = without.after(1);
    CHECK(a.position == b.position);
    const int d = *dimensions - '0';
    Rows once = laplacian(b.position, b.velocity, with.plan.vol, d);
    const double limit = 0.05 * std::sqrt(9.81 / 0.2);  // h/s
    for (std::size_t k = 0; k < once.size(); k += 3) {
      const double large = std::hypot(once[k], once[k + 1], once[k + 2]) / limit;
      for (std::size_t c = k; c < k + 3; ++c) once[c] /= 1 + large * large;
    }
    const Rows twice = laplacian(b.position, once, with.plan.vol, d);
    // sqrt(g/h) for four steps; the next predictions take over 0.4 of it, and of that, again.
    const double c = 4 * 0.02 * std::sqrt(9.81 / 0.2) * (1 - 0.4);
    double largest = 0, momentum[3] = {}, change = 0;
    for (std::size_t k = 0; k < b.velocity.size(); ++k) {
      const double taken = b.velocity[k] - a.velocity[k];
      largest = std::max(largest, std::fabs(taken - c * twice[k]));
      change = std::max(change, std::fabs(taken));
      momentum[k % 3] += taken;
    }
    CHECK(change > 0.01);
    CHECK(largest < 1e-3 * change);  // lists miss pairs that have come within h since
    for (const double m : momentum) CHECK(std::fabs(m) < 1e-12);
  }
}

TEST_CASE("hyperviscosity: the same bits by any batches, passes, measurements and after a resume") {
  for (const std::string set : {"solver.substeps=1", "solver.substeps=3", "domain.loads=true"}) {
    CAPTURE(set);
    Pool whole(kFilled, {set});
    const SolverState end = whole.after(23);
    Pool single(kFilled, {set});
    for (int k = 0; k < 23; ++k) {
      single.solver->step(1);
      if (k % 3 == 0) single.solver->diagnose();
    }
    CHECK(same(single.solver->state(), end));
    Pool traced(kFilled, {set});
    for (int k = 0; k < 23; ++k) traced.solver->inspection()->trace({});
    CHECK(same(traced.solver->state(), end));
    Pool first(kFilled, {set}), second(kFilled, {set});
    const SolverState stop = first.after(10);
    second.solver->set_state(stop);
    CHECK(same(second.after(13), end));
  }
}

TEST_CASE("hyperviscosity acts at the same times, however many steps an update has") {
  const auto difference = [](int level, const std::vector<int>& batches) {
    StepOptions options;
    options.level = level;
    Pool with(kFilled, {"time.adaptive={}"}),
        without(kFilled, {"time.adaptive={}", "solver.hyperviscosity=0"});
    for (const int updates : batches) {
      with.solver->step(updates, options);
      without.solver->step(updates, options);
    }
    return !same(with.solver->state(), without.solver->state());
  };
  for (const int level : {0, 1, 3}) {
    CAPTURE(level);
    CHECK_FALSE(difference(level, {3}));
    CHECK(difference(level, {4}));
    CHECK(difference(level, {1, 2, 1}));
  }
}

TEST_CASE("hyperviscosity: how often and how strongly it acts follows from the scene") {
  const auto of = [](std::vector<std::string> set) {
    return hyperviscosity_of(scene_test::parse(kFilled, std::move(set)));
  };
  const double unit = std::sqrt(9.81 / 0.2);  // 1/s
  for (const double step : {1e-5, 1e-3, 0.01, 0.1, 1.0}) {
    const Hyperviscosity h = of({"time.step=" + std::to_string(step)});
    CAPTURE(step, h.every);
    CHECK(h.factor == Approx(std::min(h.every * step * unit, 1.0)));
    const double pause = h.every * step * unit;
    CHECK((h.every == 1 || (pause > 0.35 && pause < 0.71)));
  }
  // Above 1 it acts more often instead: c is at most 1. Levels have 4.
  for (const double rate : {2.0, 4.0, 10.0}) {
    const Hyperviscosity h =
        of({"time.step=0.001", "solver.hyperviscosity=" + std::to_string(rate)});
    CAPTURE(rate, h.every, h.factor);
    CHECK(h.factor == Approx(std::min(rate * h.every * 0.001 * unit, 1.0)));
    CHECK(h.factor > 0.35);
    CHECK(h.every * rate * 0.001 * unit < 0.71);
  }
  CHECK(of({"solver.levels=on", "time.step=0.001"}).every ==
        of({"solver.hyperviscosity=4", "time.step=0.001"}).every);
  CHECK(of({"solver.levels=on", "time.order=1"}).every == 0);
  CHECK(of({"solver.hyperviscosity=0.1", "time.order=1"}).every == 4);
  CHECK(of({"solver.hyperviscosity=0.1"}).factor == Approx(0.1 * 4 * 0.02 * unit));
  for (const char* none :
       {"time.order=1", "solver.hyperviscosity=0", "gravity=[0, 0, 0]", "solver.iterations=0"})
    CHECK(of({none}).every == 0);
}
