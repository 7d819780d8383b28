// The faults that the guard looks for in each stage, and what it finds. Lengths are in h from the
// domain's lower corner, velocities in h/s along the scene's axes, sums per particle mass.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace pbf::inline solver_module {

/// Why a run is stopped. The words of kAlarmNames stand in messages and in suite files.
enum class Alarm { non_finite, outside, speed, energy, neighbors };
constexpr const char* kAlarmNames[] = {"non_finite", "outside", "speed", "energy", "neighbors"};

/// Beyond these a stage is at fault; infinite: not looked at.
struct StageLimits {
  double speed = std::numeric_limits<double>::infinity();   ///< h/s, of one particle
  double energy = std::numeric_limits<double>::infinity();  ///< (h/s)^2, sum of v^2/2 - g.x
  std::int64_t neighbors = std::numeric_limits<std::int64_t>::max();
};

/// The first stage that left something beyond the limits behind, and the particle: the one with
/// the smallest id, or the fastest one where no particle alone is to blame (energy).
struct StageEvent {
  Alarm alarm = Alarm::non_finite;
  std::int64_t update = 0;  ///< the first update is 1
  std::string stage;        ///< name of the pass
  std::string remedy;       ///< of PassInfo
  int iteration = 0;        ///< 1, 2, ... within the iterations, 0 outside them
  int id = 0;
  double position[3] = {0, 0, 0}, velocity[3] = {0, 0, 0};
  double value = 0;  ///< speed, energy or number of neighbours; else the value that is wrong
};

/// For tests: what `stage` of an update leaves behind of one particle is replaced. A finite value
/// goes into the velocity along x; others into what the stage stores: lambda, the density, else
/// the velocity along x.
struct Fault {
  std::int64_t update = 1;
  std::string stage;
  int iteration = 0;  ///< 1, 2, ... for density, lambda and delta
  int id = 0;
  double value = 0;  ///< h/s for a velocity
};

}  // namespace pbf::inline solver_module
