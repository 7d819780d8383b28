// An update at level k consists of 2^k complete steps of time.step/2^k (sort, lists, iterations).
// Level 0 is an update without time.adaptive. Schedules always count whole updates.
#pragma once

#include <cstdint>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// The finest level that time.adaptive.step_min allows; 0 without time.adaptive.
int finest_level(const Scene& scene);

/// The longest step, s, for the largest speed (m/s) and acceleration (m/s^2):
/// min(cfl h/v, force sqrt(h/a)), after Monaghan 1992, Smoothed particle hydrodynamics, ARAA 30.
/// Infinite if neither limits it. Needs time.adaptive.
double longest_step(const Scene& scene, double speed, double acceleration);

/// The level after `level`: finer at once, until the step is at most `longest` (or at the finest
/// level); coarser by one if `may_coarsen` and twice the coarser step is at most `longest`.
int next_level(const Scene& scene, int level, double longest, bool may_coarsen);

/// A scene of which 2^level updates give the bits of one update at this level. A step then has the
/// 2^level-th root of the damping and the XSPH coefficient c/2^level: to first order in c, the
/// smoothing per update is the same. A displacement in a step of dt acts like a force over dt^2, so
/// the artificial pressure is k/4^level. solver.speed_limit (m/s) does not change.
Scene scene_at_level(const Scene& scene, int level);

/// The state and the counters of the choice of levels (lib/run/step_control.h). Checkpoints store
/// it. "Due" measurements are those of the schedule.
struct StepHistory {
  std::int64_t level = 0;
  std::int64_t hold = 0;         ///< due measurements until a coarser step is tried
  std::int64_t hold_length = 8;  ///< length of the next hold
  std::int64_t coarse = -1;      ///< due measurements since a coarser step was tried; -1: never
  double time = 0;               ///< s, of the last due measurement
  double speed = -1;             ///< m/s, largest one then; below 0: no measurement yet
  std::int64_t changes = 0;
  std::int64_t repeats = 0;             ///< alarms after which the run went back
  std::int64_t floor = 0;               ///< due measurements that asked for less than step_min
  std::int64_t unresolved = 0;          ///< Diagnostics::unresolved of the last due measurement
  std::int64_t since = 0;               ///< the update at which the present level began
  std::vector<std::int64_t> updates{};  ///< updates at each level, until `since`
  bool operator==(const StepHistory&) const = default;
};

}  // namespace pbf::program_module
