// What is measured holds where lists of an update do not, and substeps renew their lists in time.
#include <algorithm>
#include <cmath>

#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;

namespace {

/// Mean compression and the most neighbors by all pairs, from what a download says.
struct ByAllPairs {
  double mean = 0, max = 0;
  std::int64_t neighbors_max = 0;
};
ByAllPairs by_all_pairs(const Case& c, const pbf::Snapshot& s) {
  const auto x = s.find("position")->as<double>();
  std::vector<oracle::V> points;
  for (std::size_t i = 0; i < c.particles.size(); ++i)
    points.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
  ByAllPairs out;
  for (const auto rho : oracle::densities(points, settings_of(c))) {
    const double compression = std::max(double(rho / 1000) - 1, 0.0);
    out.mean += compression / double(points.size());
    out.max = std::max(out.max, compression);
  }
  const auto h = static_cast<long double>(c.scene.h());
  for (const oracle::V& a : points) {
    std::int64_t near = -1;  // not itself
    for (const oracle::V& b : points) {
      const auto dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
      near += dx * dx + dy * dy + dz * dz < h * h ? 1 : 0;
    }
    out.neighbors_max = std::max(out.neighbors_max, near);
  }
  return out;
}

void check_against_all_pairs(const Case& c, pbf::Solver& solver) {
  const pbf::Diagnostics m = solver.diagnose();
  const auto snapshot = solver.download({"density"}, pbf::ScalarType::f64).get();
  const ByAllPairs e = by_all_pairs(c, snapshot);
  const double tolerance = is_double() ? 1e-9 : 1e-4;
  CHECK(m.compression_mean == Approx(e.mean).epsilon(tolerance).margin(tolerance));
  CHECK(m.compression_max == Approx(e.max).epsilon(tolerance).margin(tolerance));
  CHECK(std::abs(m.neighbors_max - e.neighbors_max) <= (is_double() ? 0 : 1));
  const auto density = snapshot.find("density")->as<double>();
  double mean = 0;
  for (const double rho : density)
    mean += std::max(rho / 1000 - 1, 0.0) / double(c.particles.size());
  CHECK(mean == Approx(e.mean).epsilon(tolerance).margin(tolerance));
}

/// Two blocks that meet at a speed of several h per step.
Case collision() {
  Case c = here(jittered_block(12, 6, 6, 0.1, 0));
  c.scene.domain.max[0] += 0.5;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    auto &x = c.particles.position[i], &v = c.particles.velocity[i];
    const bool right = i % 12 >= 6;
    if (right) x[0] += 0.1;
    v = {right ? -40.0 : 40.0, 0, 0};
  }
  return c;
}

}  // namespace

TEST_CASE("measures and frames of a collision are those of all pairs, after every update") {
  const Case c = collision();
  auto solver = make(c);
  for (int k = 0; k < 4; ++k) {
    CAPTURE(k);
    solver->step(1);
    check_against_all_pairs(c, *solver);
  }
}

TEST_CASE("measures and frames of an over-full box are those of all pairs") {
  // Three times the particles that it holds at rest.
  Case c = here(jittered_block(9, 9, 9, 0.45, 0, 3, 0.65));
  for (std::size_t k = 0; k < 3; ++k) c.scene.domain.max[k] = c.scene.domain.min[k] + 0.12;
  auto solver = make(c);
  solver->step(20);
  check_against_all_pairs(c, *solver);
}

TEST_CASE("a dam break gains no energy with however many substeps in an update") {
  Case c = here(flat_block(14, 24, 0, 0));
  // Away from corners, so that nothing is compressed at the start.
  c.scene.domain.min[0] -= 0.3;
  c.scene.domain.max[0] += 0.6;
  c.scene.solver.iterations = 1;
  const auto [step, substeps] =
      GENERATE(std::pair{0.016, 32}, std::pair{0.016, 64}, std::pair{0.008, 200});
  CAPTURE(step, substeps);
  c.scene.time.step = step;
  c.scene.solver.substeps = substeps;
  auto solver = make(c);
  const double start = solver->diagnose().energy;
  double highest = 0;
  for (double t = 0; t < 0.5; t += step) {
    solver->step(1);
    const pbf::Diagnostics m = solver->diagnose();
    highest = std::max(highest, m.energy);
    REQUIRE(m.non_finite + m.outside == 0);
  }
  CHECK(highest < 1.001 * start);
}

TEST_CASE("few substeps share one list, many make several, one substep none of its own") {
  Case c = flat_block(14, 24, 0, 0);
  c.scene.time.step = 0.008;
  const auto lists = [&](int substeps) {
    c.scene.solver.substeps = substeps;
    return pbf::make_plan(c.scene, 336).lists_per_update;
  };
  CHECK(lists(1) == 1);
  CHECK(lists(2) == 1);
  CHECK(lists(200) > 3);
  CHECK(lists(1000) > lists(200));
  Case at_rest = c;
  at_rest.scene.gravity = {0, 0, 0};
  at_rest.scene.solver.substeps = 200;
  CHECK(pbf::make_plan(at_rest.scene, 336).lists_per_update == 1);
  at_rest.scene.bodies.push_back({});
  at_rest.scene.bodies.back().shape = pbf::Shape::file;  // its velocities are not known
  CHECK(pbf::make_plan(at_rest.scene, 336).lists_per_update == 25);
  c.scene.bodies.push_back({});
  c.scene.bodies.back().velocity = {1e5, 0, 0};
  CHECK(lists(8) == 8);  // never more than there are substeps
}

TEST_CASE("lists are those of all pairs, with a clump of 2000 neighbors and rows of every length") {
  // More particles than several threads of a GPU share, at rest: they are where they start.
  Case c = here(jittered_block(35, 35, 35, 0.4, 0));
  c.scene.gravity = {};
  c.scene.solver.prestabilize = false;
  const double h = c.scene.h();
  auto& x = c.particles.position;
  const pbf::Double3 middle = x[20000];
  for (std::size_t k = 0; k < 2000; ++k)  // a spiral within 0.45 h
    for (std::size_t d = 0; d < 3; ++d)
      x[k][d] = middle[d] + 0.26 * h * std::sin(double(k) * (0.7 + 0.11 * double(d)) + double(d));
  auto solver = make(c);
  const pbf::StepTrace trace = solver->inspection()->trace();
  const auto distance = [&](std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t d = 0; d < 3; ++d) sum += (x[a][d] - x[b][d]) * (x[a][d] - x[b][d]);
    return std::sqrt(sum) / h;
  };
  const double edge = is_double() ? 1e-12 : 2e-5;  // h, where rounding decides
  std::size_t most = 0, wrong = 0;
  for (std::size_t i = 0; i < x.size(); i += i < 2000 ? 97 : 211) {
    const auto first = trace.neighbors.begin() + trace.neighbor_begin[i],
               last = trace.neighbors.begin() + trace.neighbor_begin[i + 1];
    most = std::max(most, std::size_t(last - first));
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double q = distance(i, j);
      const bool listed = std::binary_search(first, last, int(j));
      wrong += std::abs(q - 1) > edge && listed != (q < 1 && i != j);
    }
    wrong += std::adjacent_find(first, last) != last;  // twice
  }
  CHECK(wrong == 0);
  CHECK(most > 2000);
}
