// Time per update of one scene on one backend: what `pbf bench` prints.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/solver.h"

namespace pbf::campaign_module {

struct BenchSettings {
  int warmup = 400;  ///< updates before timing, so that the state is disordered and flowing
  int updates = 64;  ///< updates of one repeat
  int repeats = 5;
};

/// One line of the benchmark. Times in ms per update; a repeat times `updates` updates at once.
struct BenchRow {
  std::string scene;  ///< its name
  SolverInfo solver;
  std::int64_t particles = 0;
  std::string state;  ///< "start" (from the initial lattice) or "late" (after the warm-up)
  std::int64_t first_update = 0;
  BenchSettings settings;
  int iterations = 0;
  double dt = 0, h = 0;  ///< s, m
  double ms_median = 0, ms_min = 0, ms_max = 0;
  double cpu_ms_median = 0;  ///< CPU time of all threads, independent of other programs
  Diagnostics measures;
  double peak_mb = 0;             ///< host memory of the process so far, MiB
  std::vector<StageTime> stages;  ///< seconds per update (`calls`: 1)
};

/// The built-in scene of the benchmark: a dam break with artificial pressure and viscosity,
/// 4 iterations, h = 2 d, no output.
std::string bench_scene_yaml();

/// The scene with about n particles: random boxes get n particles; otherwise the spacing is scaled,
/// and the time step with sqrt(h), so that dt sqrt(g/h) is constant. `dir` anchors file bodies.
Scene scaled_to(const Scene& scene, std::int64_t n, const std::string& dir);

/// Runs the scene: one row for the first updates and one after the warm-up (none if warm-up is 0).
std::vector<BenchRow> bench(const Scene& scene, const std::string& dir, const BenchSettings& s);

}  // namespace pbf::campaign_module
