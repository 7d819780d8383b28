// Selects the time step from the flow (time.adaptive).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/program/time_levels.h"
#include "lib/scene/scene.h"
#include "lib/solver/diagnostics.h"

namespace pbf::run_module {

/// The time level of a run. Every change returns a line for the log.
class AdaptiveStep {
 public:
  /// The scene must have time.adaptive.
  explicit AdaptiveStep(const Scene& scene, const StepHistory& before = {});

  /// The level after a scheduled measurement. The greatest acceleration is estimated as |gravity|
  /// with the motion of the tank or, if larger, the change of the maximum speed since the previous
  /// scheduled measurement per time; this needs no array and sees what accelerates the fastest
  /// particle. A coarser step that proves too long within 8 scheduled measurements (here or by an
  /// alarm) was tried too early: the next try waits for 16, then 32 and so on, so that M
  /// measurements have about log2(M) such failures.
  std::optional<std::string> follow(const Diagnostics& m);

  /// One level finer from update `back` on, after an alarm (its name) at measurement m; nothing at
  /// the finest level. The next coarser step waits for at least 8 scheduled measurements.
  std::optional<std::string> refine(const std::string& alarm, const Diagnostics& m,
                                    std::int64_t back);

  int level() const { return int(h_.level); }
  double step(int level) const;  ///< s
  const StepHistory& history() const { return h_; }
  /// Number of updates at each level until `update`.
  std::vector<std::int64_t> updates_at_levels(std::int64_t update) const;

 private:
  std::string change(int to, std::int64_t update, bool alarm);

  Scene scene_;  ///< with its free bodies where they were last measured
  int finest_;
  StepHistory h_;
};

}  // namespace pbf::run_module
