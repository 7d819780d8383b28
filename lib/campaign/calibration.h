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

namespace pbf::inline campaign_module {

/// One measured state: ms of one pass through every stage.
struct StageCosts {
  std::string backend, precision, device;
  int threads = 0;  ///< 0 on cuda
  std::int64_t particles = 0;
  std::map<std::string, double> ms;  ///< by stage
};

/// $PBF_CALIBRATION, else $XDG_DATA_HOME/pbf/calibration.csv, else
/// ~/.local/share/pbf/calibration.csv; empty where none of them is set, as in services.
std::string calibration_path();

/// The scene that is measured: the benchmark's with every pass on. YAML.
std::string calibration_scene_yaml();

/// From a late row of the benchmark of that scene.
StageCosts calibration_of(const BenchRow& row);

/// All that is stored; none where the file is not there or the path is empty. Error(io) for one
/// that cannot be read, Error(bad_input), naming the line, for one that cannot be understood.
std::vector<StageCosts> read_calibration(const std::string& path);

/// Stores `rows`, in place of those of the same backend, precision, device, threads and number of
/// particles. Makes the folder. Error(io).
void store_calibration(const std::string& path, const std::vector<StageCosts>& rows);

struct TimeEstimate {
  double ms = 0;      ///< per update
  std::string basis;  ///< device and sizes it was measured with
};

/// Sum over the stages of the plan: ms of one pass, interpolated between the measured sizes (in
/// proportion to the particles beyond them), times its passes, times the scene's neighbours over
/// those of the measured scene. Nothing where no stored row has the scene's backend, precision and,
/// on the CPU, `threads` and `cpu`.
std::optional<TimeEstimate> estimate_time(const Plan& plan, const Scene& scene,
                                          const std::vector<StageCosts>& rows, int threads,
                                          const std::string& cpu);

/// What to expect of a run's time, and how far to trust it.
struct RunTime {
  double seconds = 0;        ///< of all updates
  bool rough = false;        ///< a rule of thumb, nothing was measured here
  bool least = false;        ///< the scene may repeat steps or iterations
  std::string basis;         ///< "by pbf bench --calibrate on AMD EPYC"
  std::string text() const;  ///< "about 5.1 s for the updates, ..."
};

/// From `measured` (estimate_time()); where there is nothing from kRoughRate, on the CPU. On a
/// device nothing is known then: GPUs differ too much.
std::optional<RunTime> run_time(const Plan& plan, const Scene& scene,
                                const std::optional<TimeEstimate>& measured, int threads);

/// Particles that one CPU thread updates in a second, with 4 iterations, h = 2 d and float: the
/// front page's times on one core. Within a factor of three on processors of the last ten years.
inline constexpr double kRoughRate = 1.2e6;

}  // namespace pbf::inline campaign_module
