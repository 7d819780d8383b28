// Every backend and precision against the same oracles, and against the CPU.
#include <array>

#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::same_bytes;

namespace {

void everything_on(pbf::Scene& s) {
  s.tensile = pbf::Tensile{};
  s.viscosity = pbf::Viscosity{};
  s.vorticity = pbf::Vorticity{};
}

std::vector<double> positions(pbf::Solver& s) {
  const auto snap = s.download({}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>();
  return {x.begin(), x.end()};
}

/// Differences of all coordinates, in h, from the CPU in double after `updates` updates.
struct Distance {
  double rms = 0, worst = 0;
  pbf::Diagnostics here, reference;
};
Distance from_cpu(Case c, int updates) {
  auto a = make(c);
  c.scene.backend = pbf::Backend::cpu;
  c.scene.precision = pbf::Precision::dbl;
  auto b = make(c);
  a->step(updates);
  b->step(updates);
  const auto x = positions(*a), y = positions(*b);
  Distance d{0, 0, a->diagnose(), b->diagnose()};
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double e = std::fabs(x[k] - y[k]) / c.scene.h();
    d.worst = std::max(d.worst, e);
    d.rms += e * e;
  }
  d.rms = std::sqrt(d.rms / double(x.size()));
  return d;
}

}  // namespace

TEST_CASE("one update equals the brute-force oracle, feature by feature", "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(15, 14, 0.3, 0.4) : jittered_block(6, 5, 7, 0.3, 0.4));
  SECTION("defaults") {}
  SECTION("first order") { c.scene.time.order = pbf::TimeOrder::first; }
  SECTION("first order, artificial pressure, viscosity") {
    c.scene.time.order = pbf::TimeOrder::first;
    c.scene.tensile = pbf::Tensile{0.01, 0.25, 4};
    c.scene.viscosity = pbf::Viscosity{0.3};
  }
  SECTION("the paper's kernels") { c.scene.solver.kernels = pbf::KernelMode::paper; }
  SECTION("two-sided, walls that only clamp, a margin") {
    c.scene.solver.constraint = pbf::ConstraintMode::two_sided;
    c.scene.solver.boundary = pbf::BoundaryMode::clamp;
    c.scene.solver.wall_margin = 0.01;
  }
  SECTION("artificial pressure") { c.scene.tensile = pbf::Tensile{0.01, 0.25, 4}; }
  SECTION("viscosity") { c.scene.viscosity = pbf::Viscosity{0.3}; }
  SECTION("vorticity confinement") { c.scene.vorticity = pbf::Vorticity{20}; }
  SECTION("unfused") { c.scene.solver.fused = false; }
  SECTION("no iterations") { c.scene.solver.iterations = 0; }
  SECTION("everything, the paper's kernels, h = 3 d") {
    everything_on(c.scene);
    c.scene.solver.kernels = pbf::KernelMode::paper;
    c.scene.fluid.smoothing_ratio = 3;
  }
  const Difference d = against_oracle(c);
  CHECK(d.position < (is_double() ? 1e-12 : 2e-5));
  CHECK(d.velocity < (is_double() ? 3e-12 : 4e-5));
}

TEST_CASE("the density and the neighbor counts of a state equal brute force over all pairs") {
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(24, 21, 0.4, 0) : jittered_block(9, 8, 7, 0.4, 0));
  int updates = 0;
  SECTION("at the start") {}
  SECTION("after substeps, in which particles meet that no list of theirs names") {
    c.scene.gravity[2] *= 4;
    c.scene.solver.substeps = 10;
    c.scene.solver.iterations = 1;
    c.scene.time.step = 0.2;
    updates = 3;
  }
  auto s = make(c);
  s->step(updates);
  const auto snap = s->download({"density"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), density = snap.find("density")->as<double>();
  std::vector<oracle::V> points;
  for (std::size_t i = 0; i < snap.count; ++i)
    points.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
  const auto expected = oracle::densities(points, settings_of(c));
  for (std::size_t i = 0; i < snap.count; ++i)
    REQUIRE(density[i] == Approx(double(expected[i])).epsilon(is_double() ? 1e-10 : 1e-5));
  std::int64_t pairs = 0, most = 0;
  for (std::size_t i = 0; i < snap.count; ++i) {
    std::int64_t mine = 0;
    for (std::size_t j = 0; j < snap.count; ++j)
      if (i != j && std::hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1],
                               x[3 * i + 2] - x[3 * j + 2]) < c.scene.h())
        ++mine;
    pairs += mine;
    most = std::max(most, mine);
  }
  const auto m = s->diagnose();
  CHECK(m.neighbors_mean * double(snap.count) == Approx(double(pairs)).margin(is_double() ? 0 : 4));
  CHECK(m.neighbors_max == most);
}

TEST_CASE("100 updates stay near the CPU in the measures that chaos does not touch", "[slow]") {
  Case c = here(jittered_block(16, 16, 24, 0.1, 0));
  c.scene.domain.max[0] += 0.4;
  everything_on(c.scene);
  auto a = make(c);
  c.scene.backend = pbf::Backend::cpu;
  c.scene.precision = pbf::Precision::dbl;
  auto b = make(c);
  a->step(100);
  b->step(100);
  const auto m = a->diagnose(), r = b->diagnose();
  const double energy = r.potential_energy + r.kinetic_energy;
  CHECK(std::fabs(m.potential_energy + m.kinetic_energy - energy) < 1e-3 * energy);
  for (int k = 0; k < 3; ++k)
    CHECK(m.center_of_mass[k] == Approx(r.center_of_mass[k]).margin(1e-3 * c.scene.h()));
  CHECK(m.compression_mean == Approx(r.compression_mean).epsilon(0.02));
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
}

TEST_CASE("10 updates move every particle as the CPU in double does, to the precision in use") {
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(60, 48, 0.2, 0.2) : jittered_block(12, 12, 20, 0.2, 0.2));
  everything_on(c.scene);
  CHECK(from_cpu(c, 10).worst < (is_double() ? 1e-10 : 1e-3));
}

/// Three updates of particles in a box of so many half cells along x, 8 cells along y and z.
static double off_cpu_in_long_box(Case c, int particles, int cells) {
  const double h = c.scene.h(), edge[3] = {(cells - 0.5) / 2 * h, 7.5 * h, 7.5 * h};
  for (std::size_t k = 0; k < 3; ++k) c.scene.domain.max[k] = c.scene.domain.min[k] + edge[k];
  const pbf::Plan plan = pbf::make_plan(c.scene, particles);
  REQUIRE(plan.cells[0] * plan.cells[1] * plan.cells[2] * 4 == 256 * cells);
  return from_cpu(c, 3).worst;
}

TEST_CASE("particles are sorted in a box of however many bins") {
  // One block of a device sorts few particles by counters in shared memory, of which 12288 would
  // fill all that every device has.
  const std::array<int, 2> cells =
      GENERATE(std::array{46, 16}, std::array{48, 100}, std::array{50, 2100});
  const int few = cells[0], more = cells[1];
  CAPTURE(few, more);
  const double most = is_double() ? 1e-11 : 1e-4;
  CHECK(off_cpu_in_long_box(here(jittered_block(6, 5, 7, 0.3, 0.4)), 210, few) < most);
  CHECK(off_cpu_in_long_box(here(jittered_block(15, 15, 14, 0.3, 0.4)), 3150, more) < most);
}

TEST_CASE("5 updates follow the CPU at every size that shares its sums among fewer threads",
          "[slow]") {
  // A device shares neighbor sums among 8, 4, 2 and 1 threads at these edges of a cube (10648 to
  // 125000 particles), among 4, 2 and 1 at those of a square (2809 to 60025), and lists among 2 and
  // 1; 16 share in the smaller cubes of other tests.
  const bool flat = GENERATE(false, true);
  const int k = GENERATE(0, 1, 2, 3);
  const int cube[] = {22, 31, 40, 50}, square[] = {53, 100, 173, 245};
  CAPTURE(flat, k);
  Case c = here(flat ? flat_block(square[k], square[k], 0.2, 0.2)
                     : jittered_block(cube[k], cube[k], cube[k], 0.2, 0.2));
  everything_on(c.scene);
  const Distance d = from_cpu(c, 5);
  // In float the worst of up to 375000 coordinates is one of a particle thrown off the surface:
  // 1.4e-3 on either backend.
  CHECK(d.rms < (is_double() ? 1e-12 : 1e-5));
  CHECK(d.worst < (is_double() ? 1e-10 : 5e-3));
  CHECK(d.here.neighbors_mean ==
        Approx(d.reference.neighbors_mean).epsilon(is_double() ? 1e-12 : 1e-4));
}

TEST_CASE("two runs of one scene give the same bytes", "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(64, 60, 0.3, 0.4) : jittered_block(16, 16, 16, 0.3, 0.4));
  everything_on(c.scene);
  auto a = make(c), b = make(c);
  a->step(75);                                 // in one piece
  for (int k : {1, 2, 7, 13, 52}) b->step(k);  // and in several
  CHECK(same_bytes(a->download({"velocity", "density"}, pbf::ScalarType::f32).get(),
                   b->download({"velocity", "density"}, pbf::ScalarType::f32).get()));
}

TEST_CASE("with solver.reproducible the CPU's bytes come out, on 1 thread or more", "[slow]") {
  // At these sizes the device sorts in one block, makes lists by eight threads each, and by one.
  const int edge = GENERATE(12, 24, 40);
  Case c = here(jittered_block(edge, edge, edge, 0.3, 0.4));
  if (edge > 30 && c.scene.backend == pbf::Backend::cpu) return;  // of no other kind for the CPU
  SECTION("every feature") { everything_on(c.scene); }
  SECTION("every feature, in two dimensions") {
    c = here(flat_block(4 * edge, edge * edge / 4, 0.3, 0.4));
    everything_on(c.scene);
  }
  SECTION("the paper's kernels, two-sided, unfused") {
    c.scene.solver.kernels = pbf::KernelMode::paper;
    c.scene.solver.constraint = pbf::ConstraintMode::two_sided;
    c.scene.solver.fused = false;
    c.scene.viscosity = pbf::Viscosity{0.3};
  }
  SECTION("Chebyshev's steps, three substeps") {
    c.scene.solver.method = pbf::SolverMethod::chebyshev;
    c.scene.solver.substeps = 3;
    c.scene.solver.velocity_damping = 0.99;
    c.scene.viscosity = pbf::Viscosity{0.3};
  }
  SECTION("particles in one place") {
    for (std::size_t i = 1; i < c.particles.size(); i += 97)
      c.particles.position[i] = c.particles.position[i - 1];
  }
  c.scene.solver.reproducible = true;
  auto a = make(c);
  c.scene.backend = pbf::Backend::cpu;
  c.scene.threads = 1;
  auto b = make(c);
  const int updates = edge > 30 ? 12 : 60;
  a->step(updates);
  b->step(updates);
  CHECK(same_bytes(a->download({"velocity", "density"}, pbf::ScalarType::f64).get(),
                   b->download({"velocity", "density"}, pbf::ScalarType::f64).get()));
  const auto m = a->diagnose(), r = b->diagnose();
  CHECK(m.kinetic_energy == r.kinetic_energy);
  CHECK(m.potential_energy == r.potential_energy);
  CHECK(m.compression_mean == r.compression_mean);
}

TEST_CASE("a download started before further updates holds the state of its start") {
  Case c = here(jittered_block(8, 8, 8, 0.3, 0.4));
  auto a = make(c), b = make(c);
  a->step(5);
  b->step(5);
  const auto expected = a->download({"velocity"}, pbf::ScalarType::f32).get();
  auto under_way = b->download({"velocity"}, pbf::ScalarType::f32);
  b->step(30);
  const auto got = under_way.get();
  CHECK(same_bytes(expected, got));
  CHECK(got.update == 5);
  CHECK(b->updates() == 35);
}

TEST_CASE("degenerate states stay finite and inside") {
  Case c = here(jittered_block(1, 1, 1, 0, 0));
  c.scene.domain.max = {0.1, 0.5, -1.8};
  const auto one = c.particles.position[0];
  SECTION("one particle") {}
  SECTION("two in one place") { c.particles.position.assign(2, one); }
  SECTION("300 in one place") { c.particles.position.assign(300, one); }
  SECTION("in all corners") {
    c.particles.position.clear();
    for (int k = 0; k < 64; ++k)
      c.particles.position.push_back({(k & 1 ? c.scene.domain.max : c.scene.domain.min)[0],
                                      (k & 2 ? c.scene.domain.max : c.scene.domain.min)[1],
                                      (k & 4 ? c.scene.domain.max : c.scene.domain.min)[2]});
  }
  SECTION("crossing 100 boxes in one update") { c.particles.velocity[0] = {1e4, -1e4, 5e3}; }
  c.particles.velocity.resize(c.particles.position.size());
  auto s = make(c);
  s->step(50);
  const auto m = s->diagnose();
  CHECK(m.non_finite == 0);
  CHECK(m.outside == 0);
}
