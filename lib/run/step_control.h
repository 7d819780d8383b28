// Selects the time step from the flow (time.adaptive).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/program/time_levels.h"
#include "lib/scene/scene.h"
#include "lib/solver/diagnostics.h"

namespace pbf::inline run_module {

/// The longest step, s, for the fastest speed (m/s) and the greatest acceleration (m/s^2):
/// min(cfl h/v, force sqrt(h/a)), after Monaghan 1992, Smoothed particle hydrodynamics, ARAA 30.
double longest_step(const Scene& scene, double speed, double acceleration);

/// The level after `level`: finer at once, as far as the step must be no longer than `longest` (or
/// to the finest); coarser by one, where `may_coarsen` and a step twice as long as the coarser one
/// would do as well.
int next_level(const Scene& scene, int level, double longest, bool may_coarsen);

/// The level of a run. Every change gives a line for its log.
class AdaptiveStep {
 public:
  /// scene.time.adaptive must be there.
  explicit AdaptiveStep(const Scene& scene, const StepHistory& before = {});

  /// The level of the updates after a measure that is due. The greatest acceleration is taken to be
  /// |gravity|, with what the motion of the tank adds, or, if more, the change of the fastest speed
  /// since the due measure before over the time in between: it needs no array, and sees what speeds
  /// up the fastest particle. A coarser step that proves too long within 8 due measures, here or by
  /// an alarm, was tried too early: the next try waits 16 of them, then 32, and so on, so that M
  /// measures see some log2(M) of these.
  std::optional<std::string> follow(const Diagnostics& m);

  /// One level finer from update `back` on, after an alarm (its name) at measure m; nothing where
  /// there is no finer one. The next coarser step waits at least 8 due measures.
  std::optional<std::string> refine(const std::string& alarm, const Diagnostics& m,
                                    std::int64_t back);

  int level() const { return int(h_.level); }
  double step(int level) const;  ///< s
  const StepHistory& history() const { return h_; }
  /// Updates at each level until `update`.
  std::vector<std::int64_t> updates_at_levels(std::int64_t update) const;

 private:
  std::string change(int to, std::int64_t update, bool alarm);

  Scene scene_;
  int finest_;
  StepHistory h_;
};

}  // namespace pbf::inline run_module
