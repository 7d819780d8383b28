// The run time of each pass on this machine. `pbf bench --calibrate` stores it in a file, and
// `pbf plan` uses it to estimate the time of an update without running anything.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/bench.h"
#include "lib/program/plan.h"

namespace pbf::campaign_module {

/// One measured state: ms per pass of every stage.
struct StageCosts {
  std::string backend, precision, device;
  int threads = 0;  ///< 0 on cuda
  std::int64_t particles = 0;
  std::map<std::string, double> ms;  ///< by stage
};

/// $PBF_CALIBRATION, else $XDG_DATA_HOME/pbf/calibration.csv, else
/// ~/.local/share/pbf/calibration.csv; empty if none is set, as in services.
std::string calibration_path();

/// YAML of the scene that is measured: that of the benchmark with every pass on.
std::string calibration_scene_yaml();

/// Costs from a late row of the benchmark of that scene.
StageCosts calibration_of(const BenchRow& row);

/// All stored costs; empty if the file is missing or the path is empty. Throws Error(io) if it
/// cannot be read, Error(bad_input) with the line if it is invalid.
std::vector<StageCosts> read_calibration(const std::string& path);

/// Stores `rows`, replacing those with the same backend, precision, device, threads and number of
/// particles. Makes the folder. Throws Error(io).
void store_calibration(const std::string& path, const std::vector<StageCosts>& rows);

struct TimeEstimate {
  double ms = 0;      ///< per update
  std::string basis;  ///< device of the measurements
};

/// Sum over the stages of the plan: ms of one pass, interpolated between the measured sizes (beyond
/// them proportional to the particles), times the number of passes, times the ratio of neighbors to
/// the measured scene. Empty if no stored row has the scene's backend, precision and, on the CPU,
/// `threads` and `cpu`.
std::optional<TimeEstimate> estimate_time(const Plan& plan, const Scene& scene,
                                          const std::vector<StageCosts>& rows, int threads,
                                          const std::string& cpu);

/// Estimated run time, and how reliable it is.
struct RunTime {
  double seconds = 0;        ///< of all updates
  bool rough = false;        ///< a rule of thumb; nothing was measured on this machine
  bool least = false;        ///< a lower bound: the scene may repeat steps or iterations
  std::string basis;         ///< "by pbf bench --calibrate on AMD EPYC"
  std::string text() const;  ///< "about 5.1 s for the updates, ..."
};

/// From `measured` (estimate_time()), otherwise on the CPU from kRoughRate. Empty on a device
/// without measurements: GPUs differ too much.
std::optional<RunTime> run_time(const Plan& plan, const Scene& scene,
                                const std::optional<TimeEstimate>& measured, int threads);

/// Particles that one CPU thread updates per second with 4 iterations, h = 2 d and float. Within a
/// factor of three on processors of the last ten years.
inline constexpr double kRoughRate = 1.2e6;

}  // namespace pbf::campaign_module
