#include "lib/campaign/bench.h"

#include <algorithm>
#include <cmath>

#include "lib/base/machine.h"
#include "lib/base/stages.h"
#include "lib/run/emit.h"
#include "lib/run/session.h"
#include "lib/run/start.h"

namespace pbf::campaign_module {

std::string bench_scene_yaml() {
  return R"(name: bench
domain: {min: [0, 0, 0], max: [2, 1, 1.25]}
fluid: {spacing: 0.02}
bodies:
  - {shape: block, min: [0, 0, 0], max: [1, 1, 1]}
time: {step: 0.002, end: 1}
solver: {iterations: 4}
tensile: {k: 0.001}
viscosity: {xsph: 0.05}
)";
}

Scene scaled_to(const Scene& scene, std::int64_t n, const std::string& dir) {
  Scene s = scene;
  std::int64_t random = 0;
  for (const Body& b : s.bodies)
    if (b.shape == Shape::random_box) random += b.count;
  if (random > 0) {
    for (Body& b : s.bodies) b.count = b.count * n / random;
    return s;
  }
  // Iterate, since lattice points come in whole layers.
  for (int round = 0; round < 4; ++round) {
    const double now = double(count_particles(s, dir));
    const double share = now / double(n);
    const double finer = s.dimensions == 2 ? std::sqrt(share) : std::cbrt(share);
    s.fluid.spacing *= finer;
    if (const auto y = s.plane())  // keep the thickness of the slab in spacings
      for (double* face : {&s.domain.min[1], &s.domain.max[1]}) *face = *y + finer * (*face - *y);
  }
  s.time.step = scene.time.step * std::sqrt(s.h() / scene.h());
  return s;
}

namespace {

std::vector<StageTime> per_update(const std::vector<StageTime>& before,
                                  const std::vector<StageTime>& after, double updates) {
  std::vector<StageTime> out;
  for (const StageTime& a : after) {
    const auto* stage = std::ranges::find(kStages, a.name, &Stage::name);
    if (stage == std::end(kStages) || !stage->of_update) continue;
    double seconds = a.seconds;
    for (const StageTime& b : before)
      if (b.name == a.name) seconds -= b.seconds;
    out.push_back({a.name, seconds / updates, 1});
  }
  return out;
}

void time_state(Session& session, const BenchSettings& s, BenchRow& row) {
  Solver& solver = session.solver();
  row.first_update = session.update();
  const auto before = solver.info().stages;
  std::vector<double> ms, cpu_ms;
  for (int r = 0; r < s.repeats; ++r) {
    const StepSeconds start = session.seconds();
    session.run(session.update() + s.updates);  // returns when the device has finished
    ms.push_back((session.seconds().wall - start.wall) * 1e3 / s.updates);
    cpu_ms.push_back((session.seconds().cpu - start.cpu) * 1e3 / s.updates);
  }
  std::ranges::sort(ms);
  std::ranges::sort(cpu_ms);
  row.cpu_ms_median = cpu_ms[cpu_ms.size() / 2];
  row.ms_median = ms[ms.size() / 2];
  row.ms_min = ms.front();
  row.ms_max = ms.back();
  row.stages = per_update(before, solver.info().stages, double(s.updates) * s.repeats);
  row.measures = solver.diagnose();
  row.solver = solver.info();
  row.peak_mb = double(peak_memory()) / (1 << 20);
}

}  // namespace

std::vector<BenchRow> bench(const Scene& scene, const std::string& dir, const BenchSettings& s) {
  Start start = prepare(scene, dir);
  const std::unique_ptr<Solver> solver = solver_of(start);
  BenchRow row;
  row.scene = scene.name;
  row.particles = start.plan.particles;
  row.settings = s;
  row.iterations = scene.solver.iterations;
  row.dt = scene.time.step;
  row.h = scene.h();
  // Includes the first use of every kernel; without a warm-up every update is timed.
  Session session(*solver);
  if (s.warmup > 0) session.run(2);
  std::vector<BenchRow> rows;
  row.state = "start";
  time_state(session, s, row);
  rows.push_back(row);
  if (s.warmup == 0) return rows;
  session.run(s.warmup);
  row.state = "late";
  time_state(session, s, row);
  rows.push_back(row);
  return rows;
}

}  // namespace pbf::campaign_module
