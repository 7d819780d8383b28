// What takes energy from the motion, against the energy of the particles.
#include <cmath>

#include "lib/program/plan.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::Series;
using pbf::Interval;
using pbf::TimeOrder;

namespace {

/// 9 x 9 x 9 particles of a lattice of `apart` spacings, far from walls, with random velocities.
Case cloud(double apart, double speed, TimeOrder order) {
  Case c = backend_test::drifting(0.004, order);
  c.scene.domain.min = {-2, -2, -2};
  c.scene.domain.max = {2, 2, 2};
  std::mt19937 gen(1);
  for (int k = 0; k < 729; ++k) {
    const double d = apart * c.scene.fluid.spacing;
    c.particles.position.push_back({d * (k % 9 - 4), d * (k / 9 % 9 - 4), d * (k / 81 - 4)});
    pbf::Double3 v;
    for (double& x : v) x = speed * random_number(gen);
    c.particles.velocity.push_back(v);
  }
  return c;
}

/// J, what one cause has taken so far.
double taken(const Case& c, pbf::Solver& solver, const std::string& by) {
  const std::vector<double> all = solver.readings(Series::measures, Interval::goes_on);
  double found = NAN;
  pbf::for_each_number(pbf::make_plan(c.scene, std::int64_t(c.particles.size())).columns,
                       Series::measures, [&](const auto& column, int, std::size_t k) {
                         if (column.kind == std::string("dissipation") && column.of == by)
                           found = all.at(k);
                       });
  return found;
}

/// J, from the velocities alone; where the particles fall, relative to the centre of mass.
double kinetic(const Case& c, pbf::Solver& solver) {
  const pbf::SolverState s = solver.state();
  double mean[3] = {0, 0, 0}, sum = 0;
  const double n = double(s.id.size()), h = c.scene.h();
  const double falls = c.scene.gravity[2] == 0 ? 0 : 1;
  for (std::size_t k = 0; k < s.velocity.size(); ++k) mean[k % 3] += falls * s.velocity[k] / n;
  for (std::size_t k = 0; k < s.velocity.size(); ++k)
    sum += std::pow(h * (s.velocity[k] - mean[k % 3]), 2);
  return 0.5 * c.scene.particle_mass() * sum;
}

}  // namespace

TEST_CASE("viscosity, confinement and damping book what the particles lose or gain") {
  Case c = cloud(1, 0.2, TimeOrder::first);
  std::string by;
  SECTION("viscosity") {
    c.scene.viscosity = pbf::Viscosity{0.05};
    by = "viscosity";
  }
  SECTION("confinement") {
    c.scene.vorticity = pbf::Vorticity{50};
    by = "confinement";
  }
  SECTION("damping") {
    c.scene.solver.velocity_damping = 0.97;
    c.scene.solver.substeps = GENERATE(1, 3);
    c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
    by = "damping";
  }
  SECTION("sponge") {
    c.scene.damping = {{"all", {-2, -2, -2}, {2, 2, 2}, "x_max", 4.0, 1, {"x", "z"}}};
    c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
    by = "sponge";
  }
  CAPTURE(by);
  auto solver = make(c);
  CHECK(taken(c, *solver, by) == 0);
  const double before = kinetic(c, *solver);
  solver->step(20);
  const double lost = before - kinetic(c, *solver);
  CHECK(std::fabs(lost) > 1e-3 * before);
  CHECK(taken(c, *solver, by) == Approx(lost).epsilon(is_double() ? 1e-6 : 1e-3));
}

TEST_CASE(
    "what viscosities take in second order, with the shares of later steps, is booked to 5 %") {
  // So far apart that nothing is compressed.
  Case c = cloud(1.3, 0.01, TimeOrder::second);
  c.scene.solver.iterations = 4;
  std::string by = "viscosity";
  SECTION("viscosity") { c.scene.viscosity = pbf::Viscosity{0.02}; }
  SECTION("hyperviscosity") {
    by = "hyperviscosity";
    c.scene.gravity = {0, 0, -1};
    c.scene.solver.hyperviscosity = 4;
    c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  }
  CAPTURE(by, int(c.scene.time.order));
  auto solver = make(c);
  const double before = kinetic(c, *solver);
  solver->step(90);  // hyperviscosity acts in every eighth
  const double lost = before - kinetic(c, *solver);
  CHECK(lost > 0.05 * before);
  CHECK(taken(c, *solver, by) == Approx(lost).epsilon(0.05));
}

TEST_CASE("what takes energy has the same bits for all threads and batches, and after a resume") {
  Case c = here(jittered_block(9, 8, 7, 0.3, 0.4));
  c.scene.domain.max[0] += 0.2;
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.vorticity = pbf::Vorticity{};
  c.scene.solver.velocity_damping = 0.99;
  c.scene.solver.hyperviscosity = 4;
  c.scene.solver.reproducible = true;
  auto whole = make(c);
  whole->step(40);
  const std::vector<double> expected = whole->readings(Series::measures, Interval::goes_on);
  REQUIRE(expected.size() == 4);
  for (const double e : expected) CHECK(e != 0);
  SECTION("on one thread, one by one, with measures that end an interval") {
    c.scene.threads = 1;
    auto parts = make(c);
    for (int k = 0; k < 40; ++k) parts->step(1), parts->readings(Series::measures, Interval::ends);
    CHECK(parts->readings(Series::measures, Interval::goes_on) == expected);
  }
  SECTION("from a state") {
    auto first = make(c);
    first->step(17);
    const pbf::SolverState s = first->state();
    first->step(5);
    first->set_state(s);
    auto second = make(c);
    second->set_state(s);
    first->step(23), second->step(23);
    CHECK(first->readings(Series::measures, Interval::goes_on) == expected);
    CHECK(second->readings(Series::measures, Interval::goes_on) == expected);
  }
}

TEST_CASE("a scene without anything that takes energy has no sums of it") {
  Case c = here(jittered_block(5, 5, 5, 0.1, 0.1));
  c.scene.solver.hyperviscosity = 0;
  CHECK(make(c)->readings(Series::measures, Interval::goes_on).empty());
}

TEST_CASE("more energy than a sum can hold of one particle is booked as that, and NaN as nothing") {
  Case c = cloud(1, 0, TimeOrder::first);
  c.scene.solver.velocity_damping = 0.5;
  c.scene.domain.max[0] = 1e6;
  c.particles.velocity[3] = {1e6, 0, 0};  // 4e4 h in a step
  auto solver = make(c);
  solver->step(1);
  const double h_per_step = c.scene.h() / c.scene.time.step;
  CHECK(taken(c, *solver, "damping") ==
        Approx(c.scene.particle_mass() * 1024 * h_per_step * h_per_step));
}
