// The rows of particles that come and go: a shower, and a drain in a corner of the floor.
#include <algorithm>
#include <cmath>
#include <set>

#include "lib/base/error.h"
#include "lib/exec/make_solver.h"
#include "lib/io/checkpoint.h"
#include "lib/run/emit.h"
#include "lib/solver/launched_rows.h"
#include "tests/support/backend.h"
#include "tests/support/folder.h"
#include "tests/support/scene_samples.h"

namespace rows_test {
using namespace pbf;
namespace {

constexpr int kLayer = 16;     // particles of the shower that come at a time
constexpr double kEdge = 0.3;  // m, of the drain

struct Emitting {
  Scene scene;
  Plan plan;
  explicit Emitting(const std::vector<std::string>& set = {}) {
    scene = scene_test::parse(
        "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
        "fluid: {spacing: 0.05}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.5, 0.4]}]\n"
        "emitters: [{name: shower, shape: rectangle, center: [0.4, 0.4, 0.7], normal: [0, 0, -1], "
        "size: [0.2, 0.2], speed: 2}]\n"
        "sinks: [{name: drain, min: [0, 0, 0], max: [0.3, 0.3, 0.3]}]\n"
        "time: {step: 0.002, end: 1, adaptive: off}\n"
        "solver: {reproducible: true}\n",
        set);
    scene.precision = backend_test::precision();
    scene.backend = backend_test::backend();
    plan = make_plan(scene, std::int64_t(particles().size()));
  }
  Particles particles() const { return emit_particles(scene, ""); }
  std::unique_ptr<Solver> on_cpu(int threads) const {
    Scene there = scene;
    there.backend = Backend::cpu;
    there.threads = threads;
    return make_solver(there, plan, particles());
  }
  std::unique_ptr<Solver> here() const { return make_solver(scene, plan, particles()); }
};

bool same(const SolverState& a, const SolverState& b) {
  return backend_test::same_particles(a, b) && a.fields == b.fields;
}
double number(const SolverState& s, std::size_t which) {
  REQUIRE(s.find("rows"));
  return s.find("rows")->values.at(which);
}

}  // namespace

TEST_CASE("rows: new particles come behind the last, and those in the drain leave") {
  const Emitting e;
  const auto solver = e.here();
  const double h = e.scene.h();
  const double edge = e.scene.precision == Precision::single ? double(float(kEdge / h)) : kEdge / h;
  SolverState before = solver->state();
  std::int64_t next = std::int64_t(before.id.size()), gone = 0;
  const std::int64_t first = next;
  for (int update = 1; update <= 120; ++update) {
    std::vector<std::int64_t> expected;
    for (std::size_t k = 0; k < before.id.size(); ++k) {
      const double* x = &before.position[3 * k];
      const bool in = x[0] <= edge && x[1] <= edge && x[2] <= edge;
      in ? void(++gone) : expected.push_back(before.id[k]);
    }
    // A layer begins when the ones before it have made half a spacing, and then each spacing more.
    const auto layers = std::int64_t(std::floor(2 * 0.002 * update / 0.05 + 0.5 + 1e-9));
    while (next < first + kLayer * layers) expected.push_back(next++);
    solver->step(1);
    before = solver->state();
    REQUIRE(before.id == expected);
    REQUIRE(number(before, 0) == double(expected.size()));
    REQUIRE(number(before, 1) == double(next));
    REQUIRE(number(before, 2) == double(gone));
  }
  CHECK(gone > 100);
  CHECK(next == first + 10 * kLayer);
  CHECK(solver->diagnose().non_finite == 0);
}

TEST_CASE("rows: the bits do not depend on threads, on the backend, or on the size of a batch") {
  const Emitting e({"solver.substeps=2"});
  const auto reference = e.on_cpu(1);
  reference->step(150);
  const SolverState expected = reference->state();
  CHECK(number(expected, 2) > 0);
  for (const int threads : {2, 3, 8}) {
    const auto other = e.on_cpu(threads);
    other->step(150);
    CHECK(same(other->state(), expected));
  }
  const auto here = e.here();
  for (const int updates : {1, 2, 17, 130}) here->step(updates);
  CHECK(same(here->state(), expected));
}

TEST_CASE("rows: a state is kept, goes back, and is in a checkpoint, from which a run resumes") {
  const Emitting e;
  const auto a = e.here();
  a->step(70);
  a->keep();
  const SolverState kept = a->state();
  a->step(50);
  const SolverState later = a->state();
  CHECK(later.id.size() != kept.id.size());
  CHECK(same(a->state(StateOf::kept), kept));
  a->set_state(kept);
  CHECK(same(a->state(), kept));
  a->step(50);
  CHECK(same(a->state(), later));

  test::TemporaryFolder folder;
  SavedRun run;
  run.state = kept;
  run.particles = std::int64_t(kept.id.size());
  write_checkpoint(folder.path, run);
  std::vector<std::string> notes;
  const auto read = read_checkpoint(folder.path, notes);
  REQUIRE(read);
  const auto resumed = e.here();
  resumed->set_state(read->state);
  resumed->step(50);
  CHECK(same(resumed->state(), later));
}

TEST_CASE("rows: a download has the ids, ascending, and the rows of the state") {
  const Emitting e;
  const auto solver = e.here();
  solver->step(80);
  const SolverState s = solver->state();
  const Snapshot shot = solver->download({"velocity", "density"}, ScalarType::f64).get();
  REQUIRE(shot.count == s.id.size());
  const auto* id = shot.find("id");
  const auto* position = shot.find("position");
  REQUIRE((id && position));
  const double h = e.scene.h();
  CHECK(s.id.back() != int(s.id.size()) - 1);  // there are gaps
  for (std::size_t k = 0; k < s.id.size(); ++k) {
    REQUIRE(id->as<std::int32_t>()[k] == s.id[k]);
    for (std::size_t c = 0; c < 3; ++c)
      REQUIRE(position->as<double>()[3 * k + c] == Approx(h * s.position[3 * k + c]));
  }
}

TEST_CASE("rows: updates are recorded anew for few numbers of launched rows") {
  const Emitting e;
  const auto solver = e.here();
  std::set<std::int64_t> launched;
  const int before = solver->info().recordings;
  for (int update = 0; update < 1000; update += 20) {
    const auto rows = std::int64_t(solver->state().id.size());
    solver->step(20);
    for (int k = 0; k <= 2 * kLayer; ++k) launched.insert(launched_rows(rows + k));
  }
  // Three lengths of recordings, two places of the arrays.
  CHECK(solver->info().recordings - before <= 6 * int(launched.size()));
  CHECK((solver->info().recordings > 0) == (e.scene.backend == Backend::cuda));
}

TEST_CASE("rows: all particles may leave, and others come later") {
  const Emitting e({"bodies.0.max=[0.25, 0.25, 0.25]", "emitters.0.start=0.02"});
  const auto solver = e.here();
  const auto waiting = std::size_t(2 * kLayer);
  const SolverState first = solver->state();
  REQUIRE(first.id.size() > waiting + 50);
  solver->step(1);
  CHECK(solver->state().id.size() == waiting);
  solver->step(40);
  CHECK(solver->state().id.size() == waiting + 2 * kLayer);
  CHECK(solver->state().id.back() == std::int64_t(first.id.size()) + 2 * kLayer - 1);
  CHECK(solver->diagnose().non_finite == 0);
}

TEST_CASE("rows: the numbers of launched rows are few, and large enough") {
  std::set<std::int64_t> all;
  for (std::int64_t rows = 100'000; rows <= 200'000; rows += 7) {
    REQUIRE(launched_rows(rows) >= rows);
    REQUIRE(double(launched_rows(rows)) <= 1.126 * double(rows));
    all.insert(launched_rows(rows));
  }
  CHECK(all.size() <= 9);
}

}  // namespace rows_test
