// An update at level k consists of 2^k complete steps of time.step/2^k (sort, lists, iterations).
// Level 0 is an update without time.adaptive. Schedules always count whole updates.
#pragma once

#include <cstdint>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// The finest level that time.adaptive.step_min allows; 0 without time.adaptive.
int finest_level(const Scene& scene);

/// The scene of which 2^level updates are one update at that level, to the last bit. Per step,
/// damping acts by its 2^level-th root and XSPH by c/2^level: to first order in c the velocities
/// are smoothed by the same in an update. A position change of a step of dt acts like a force over
/// dt^2, so the artificial pressure is k/4^level. The speed of solver.speed_limit, in m/s, stays.
Scene scene_at_level(const Scene& scene, int level);

/// What the choice of levels (lib/run/step_control.h) remembers, and what it counts; a checkpoint
/// holds it.
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
  std::int64_t unresolved = 0;          ///< Diagnostics::unresolved of the last due measure
  std::int64_t since = 0;               ///< the update at which the present level began
  std::vector<std::int64_t> updates{};  ///< at each level, until `since`
  bool operator==(const StepHistory&) const = default;
};

}  // namespace pbf::inline program_module
