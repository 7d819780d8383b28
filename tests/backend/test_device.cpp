// What only the CUDA backend does: lists that outgrow their capacity, memory that is not there.
#ifdef PBF_HAS_CUDA
#include "lib/base/error.h"
#include "lib/exec/cuda/cuda_solver.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::same_bytes;

#define NEEDS_DEVICE() \
  if (backend_test::backend() != pbf::Backend::cuda) PBF_SKIP("only of the CUDA backend")

TEST_CASE("lists that outgrow their room grow, and the result is the same") {
  NEEDS_DEVICE();
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(40, 40, 0.3, 0.4, 5, 0.5)
                     : jittered_block(12, 12, 12, 0.3, 0.4, 5, 0.7));
  const auto plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  auto roomy = pbf::make_cuda_solver(c.scene, plan, c.particles, 512);
  auto tight = pbf::make_cuda_solver(c.scene, plan, c.particles, 4);
  CHECK(roomy->diagnose().neighbors_max == tight->diagnose().neighbors_max);
  CHECK(tight->diagnose().neighbors_max > (flat ? 40 : 60));
  roomy->step(40);
  tight->step(40);
  CHECK(same_bytes(roomy->download({"velocity"}, pbf::ScalarType::f32).get(),
                   tight->download({"velocity"}, pbf::ScalarType::f32).get()));
  CHECK(tight->info().bytes < roomy->info().bytes);
}

TEST_CASE("lists that outgrow their room in the middle of a run grow, and nothing is lost") {
  NEEDS_DEVICE();
  // A blob falls into its own lower half: the counts rise long after the start.
  Case c = here(jittered_block(10, 10, 20, 0.3, 0));
  for (std::size_t i = 0; i < c.particles.size(); ++i)
    c.particles.velocity[i] = {0, 0, c.particles.position[i][2] > -1.8 ? -30.0 : 30.0};
  const auto plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  auto roomy = pbf::make_cuda_solver(c.scene, plan, c.particles, 1024);
  auto tight = pbf::make_cuda_solver(c.scene, plan, c.particles, 40);
  const auto at_start = tight->diagnose().neighbors_max;
  std::int64_t most = 0;
  for (int k = 0; k < 12; ++k) {
    roomy->step(5);
    tight->step(5);
    most = std::max(most, roomy->diagnose().neighbors_max);
  }
  CHECK(most > at_start);
  CHECK(same_bytes(roomy->download({"velocity"}, pbf::ScalarType::f32).get(),
                   tight->download({"velocity"}, pbf::ScalarType::f32).get()));
}

TEST_CASE("lists of one thread each grow when words, overflows or their length do not suffice") {
  NEEDS_DEVICE();
  Case c = here(jittered_block(35, 35, 35, 0.3, 0.4));  // more than several threads share
  if (GENERATE(false, true))  // one list with far more entries than the others
    for (int k = 0; k < 150; ++k) {
      auto& x = c.particles.position[std::size_t(k)];
      for (int d = 0; d < 3; ++d) x[d] = c.particles.position[20000][d] + 1e-4 * ((k >> d) % 7);
    }
  c.scene.solver.prestabilize = false;
  const auto plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  const auto after = [&](int entries) {
    auto solver = pbf::make_cuda_solver(c.scene, plan, c.particles, entries);
    solver->step(6);
    return solver->state();
  };
  const pbf::SolverState roomy = after(400), tight = after(4), short_of_few = after(32);
  CHECK(backend_test::same_particles(roomy, tight));
  CHECK(backend_test::same_particles(roomy, short_of_few));
}

TEST_CASE("more particles than the device's memory holds are refused before the run") {
  NEEDS_DEVICE();
  Case c = here(jittered_block(4, 4, 4, 0, 0));
  auto plan = pbf::make_plan(c.scene, 2000000000);
  try {
    pbf::make_cuda_solver(c.scene, plan, c.particles);
    FAIL("not refused");
  } catch (const pbf::Error& e) {
    CHECK(e.code() == pbf::ExitCode::unavailable);
    CHECK(std::string(e.what()).find("2000000000 particles need") != std::string::npos);
    CHECK(std::string(e.what()).find("are free") != std::string::npos);
  }
}
#endif
