// How many neighbors a start has, and the memory that over-dense starts take.
#include "lib/run/start_neighbors.h"

#include <cmath>

#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/program/simd.h"
#include "lib/run/emit.h"
#include "lib/solver/solver.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

/// Bodies in a box of 1 m with h = 0.1 m.
Scene dense(const std::string& bodies, const std::vector<std::string>& overrides = {}) {
  return scene_test::parse(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
      "fluid: {spacing: 0.05}\n"
      "bodies: [" +
          bodies +
          "]\n"
          "time: {step: 0.001, end: 1}\n"
          "threads: 1\n",
      overrides);
}

std::string random_box(int count, double edge, double from = 0.4) {
  const std::string low = std::to_string(from), high = std::to_string(from + edge);
  return "{shape: random_box, min: [" + low + ", " + low + ", " + low + "], max: [" + high + ", " +
         high + ", " + high + "], count: " + std::to_string(count) + "}";
}

const char* const kBlock = "{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}";

}  // namespace

TEST_CASE("the neighbors of a start are those that a look at every pair finds") {
  const std::string sphere = "{shape: sphere, center: [0.4, 0.4, 0.4], radius: 0.2}";
  for (const std::string& bodies :
       {random_box(900, 0.3), random_box(300, 0.02), kBlock + (", " + sphere),
        kBlock + (", " + random_box(200, 0.2, 0.1))})
    for (const int dimensions : {3, 2}) {
      CAPTURE(bodies, dimensions);
      Scene s = dense(bodies);
      if (dimensions == 2) {  // the plane cuts the bodies
        s.dimensions = 2;
        s.domain.min[1] = 0.385;
        s.domain.max[1] = 0.435;
      }
      const Particles p = emit_particles(s, ".");
      REQUIRE(p.size() <= 1024);  // so that the sample is all of them
      std::vector<int> expected(p.size());
      for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = 0; j < p.size(); ++j) {
          const double x = p.position[i][0] - p.position[j][0],
                       y = p.position[i][1] - p.position[j][1],
                       z = p.position[i][2] - p.position[j][2];
          expected[i] += std::sqrt(x * x + y * y + z * z) < s.h();
        }
      // A neighbor of a lattice at a distance of exactly h may be rounded to either side.
      const std::vector<int> found = start_neighbors({s, "."}, std::int64_t(p.size())).count;
      REQUIRE(found.size() == expected.size());
      int differ = 0;
      for (std::size_t i = 0; i < found.size(); ++i) differ += std::abs(found[i] - expected[i]) > 6;
      CHECK(differ == 0);
      if (bodies.find("block") == bodies.npos) CHECK(found == expected);
    }
}

TEST_CASE("a sample of a large start has the mean of all, and bodies side by side need none") {
  const Scene s = dense(random_box(20000, 0.3));
  const auto sample = start_neighbors({s, "."}, 20000).count;
  CHECK(sample.size() == 4096);
  double mean = 0;
  for (const int m : sample) mean += m / 4096.0;
  const Particles p = emit_particles(s, ".");
  double all = 0;
  for (std::size_t i = 0; i < p.size(); i += 10)
    for (std::size_t j = 0; j < p.size(); ++j) {
      double r2 = 0;
      for (int a = 0; a < 3; ++a)
        r2 += (p.position[i][a] - p.position[j][a]) * (p.position[i][a] - p.position[j][a]);
      all += (r2 < s.h() * s.h()) / 2000.0;
    }
  CHECK(mean == Approx(all).epsilon(0.02));
  const Scene one = dense(kBlock);
  CHECK(start_neighbors({one, "."}, 512).empty());
  const Scene beside =
      dense(kBlock + std::string(", {shape: block, min: [0.4, 0, 0], max: [0.8, 0.4, 0.4]}"));
  CHECK(start_neighbors({beside, "."}, 1024).empty());
}

// The lists of a vector are as long as the longest of them. Shorter vectors hold particles that are
// closer to each other, so that the scatter nearby says less about them.
TEST_CASE(
    "the plan counts the bytes that the CPU solver holds for over-dense starts too, to 12 %, with "
    "short vectors to 20 %") {
  const double most = chosen_simd() == Simd::avx512 ? 0.12 : 0.2;
  const std::string block = kBlock;
  for (const std::string& bodies :
       {random_box(3000, 0.02), random_box(4000, 0.2), random_box(3000, 0.3), random_box(8000, 0.6),
        block + ", " + block + ", " + block, block + ", " + random_box(4000, 0.03)})
    for (const bool dbl : {false, true}) {
      CAPTURE(bodies, dbl);
      const Scene s = dense(bodies, {std::string("precision=") + (dbl ? "double" : "float")});
      const std::int64_t n = count_particles(s, ".");
      const Plan plan = make_plan(s, n, start_neighbors({s, "."}, n));
      const auto solver = make_solver(s, plan, emit_particles(s, "."));
      solver->diagnose();
      solver->keep();
      CHECK(double(solver->info().bytes) == Approx(double(plan.bytes())).epsilon(most));
    }
}

TEST_CASE("a start too dense for the memory is refused with the number of neighbors") {
  const Scene s = dense(random_box(3000000, 0.02));
  constexpr std::size_t kAvailable = std::size_t{64} << 30;
  CHECK(scene_test::error_of([&] { refuse_if_too_large(s, make_plan(s, 3000000), kAvailable); }) ==
        "no error");
  const Plan plan =
      make_plan(s, 3000000, {std::vector<int>(256, 3000000), std::vector<double>(256)});
  for (const bool cuda : {false, true}) {
    Scene on = s;
    on.backend = cuda ? Backend::cuda : Backend::cpu;
    const MemoryPlan m = plan_memory(on, plan);
    CHECK(double(cuda ? m.device_peak() : m.host_peak()) > 9e12 * 4);
  }
  const std::string error = scene_test::error_of([&] { refuse_if_too_large(s, plan, kAvailable); });
  CAPTURE(error);
  CHECK(error.rfind("4 ", 0) == 0);
  for (const char* part : {"3000000 neighbors", "rest has 34", "bodies[].count"})
    CHECK(scene_test::contains(error, part));
}
