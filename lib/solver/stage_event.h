// The faults that the guard looks for in each stage, and its findings. Lengths are in h from the
// domain's lower corner, velocities in h/s along the scene's axes, sums per particle mass.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace pbf::solver_module {

/// Why a run is stopped. Messages and suite files use the words of kAlarmNames.
enum class Alarm { non_finite, outside, speed, energy, neighbors };
constexpr const char* kAlarmNames[] = {"non_finite", "outside", "speed", "energy", "neighbors"};

/// Limits for the results of a stage; infinite: no check.
struct StageLimits {
  double speed = std::numeric_limits<double>::infinity();   ///< h/s, of one particle
  double energy = std::numeric_limits<double>::infinity();  ///< (h/s)^2, sum of v^2/2 - g.x
  std::int64_t neighbors = std::numeric_limits<std::int64_t>::max();
};

/// The first stage whose results exceed the limits, and a particle: of those beyond the limit the
/// one with the smallest id; for the energy, which belongs to no particle, the fastest one.
struct StageEvent {
  Alarm alarm = Alarm::non_finite;
  std::int64_t update = 0;  ///< the first update is 1
  std::string stage;        ///< name of the pass
  std::string remedy;       ///< of PassInfo
  int iteration = 0;        ///< 1, 2, ... within the iterations, 0 outside them
  std::int64_t id = 0;
  double position[3] = {0, 0, 0}, velocity[3] = {0, 0, 0};
  double value = 0;  ///< speed, energy or number of neighbors; otherwise the non-finite value
};

/// For tests: replaces a result of `stage` for one particle. A finite value replaces the velocity
/// along x. A non-finite value replaces the main result of the stage (lambda, density), or the
/// velocity along x if there is none.
struct Fault {
  std::int64_t update = 1;
  std::string stage;
  int iteration = 0;  ///< 1, 2, ... for density, lambda and delta
  std::int64_t id = 0;
  double value = 0;  ///< h/s for a velocity
};

}  // namespace pbf::solver_module
