// The time step that follows the flow (time.adaptive). An update at level k is 2^k steps of
// time.step/2^k, sort, lists, sweeps and all; level 0 is an update without time.adaptive. All that
// is scheduled stays in whole updates.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/diag/measures.h"
#include "lib/scene/scene.h"

namespace pbf {

/// The finest level that time.adaptive.step_min allows; 0 without time.adaptive.
int finest_level(const Scene& scene);

/// The scene of which 2^level updates are one update at that level, to the last bit. Per step,
/// damping acts by its 2^level-th root and XSPH by c/2^level: to first order in c the velocities
/// are smoothed by the same in an update. A position change of a step of dt acts like a force over
/// dt^2, so the artificial pressure is k/4^level. The speed of solver.speed_limit, in m/s, stays.
Scene scene_at_level(const Scene& scene, int level);

/// The longest step, s, for the fastest speed (m/s) and the greatest acceleration (m/s^2):
/// min(cfl h/v, force sqrt(h/a)), after Monaghan 1992, Smoothed particle hydrodynamics, ARAA 30.
double longest_step(const Scene& scene, double speed, double acceleration);

/// The level after `level`: finer at once, as far as the step must be no longer than `longest` (or
/// to the finest); coarser by one, where `may_coarsen` and a step twice as long as the coarser one
/// would do as well.
int next_level(const Scene& scene, int level, double longest, bool may_coarsen);

/// What the choice remembers, and what it counts; a checkpoint holds it.
struct StepHistory {
  std::int64_t level = 0;
  std::int64_t hold = 0;         ///< due measures until a coarser step is tried
  std::int64_t hold_length = 8;  ///< of the next hold
  std::int64_t coarse = -1;      ///< due measures since a coarser step was tried; below 0: never
  double time = 0;               ///< s, of the last due measure
  double speed = -1;             ///< m/s, fastest there; below 0: there was none
  std::int64_t changes = 0;
  std::int64_t repeats = 0;             ///< alarms that took the run back
  std::int64_t floor = 0;               ///< due measures that asked for less than step_min
  std::int64_t unresolved = 0;          ///< Measures::unresolved of the last due measure
  std::int64_t since = 0;               ///< the update at which the present level began
  std::vector<std::int64_t> updates{};  ///< at each level, until `since`
  bool operator==(const StepHistory&) const = default;
};

/// The level of a run. Every change gives a line for its log.
class AdaptiveStep {
 public:
  /// scene.time.adaptive must be there.
  explicit AdaptiveStep(const Scene& scene, const StepHistory& before = {});

  /// The level of the updates after a measure that is due. The greatest acceleration is taken to be
  /// |gravity| or, if more, the change of the fastest speed since the due measure before over the
  /// time in between: it needs no array, and sees what speeds up the fastest particle. A coarser
  /// step that proves too long within 8 due measures, here or by an alarm, was tried too early: the
  /// next try waits 16 of them, then 32, and so on, so that M measures see some log2(M) of these.
  std::optional<std::string> follow(const Measures& m);

  /// One level finer from update `back` on, after an alarm (its name) at measure m; nothing where
  /// there is no finer one. The next coarser step waits at least 8 due measures.
  std::optional<std::string> refine(const std::string& alarm, const Measures& m, std::int64_t back);

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

}  // namespace pbf
