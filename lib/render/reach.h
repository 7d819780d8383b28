// How fast and how high the fluid of a scene may get, from the scene alone: a run does not know its
// future, and its pictures have one scale and one frame from the first to the last.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf::render_module {

/// What fluid and solids are estimated to do; nothing here bounds a single drop.
struct Reach {
  double speed = 1;  ///< m/s, near that of the fastest hundredth of the particles of a run; above 0
  double height = 0;  ///< m, along `up` from the origin: where splashes and solids end
};

/// From the energy per mass e that the start has above the same volume at rest on the floor (walls
/// closed, obstacles as at the start), which is all kinetic at a speed of sqrt(2 e):
///   speed: 1.6 sqrt(2 e), for energy is not spread evenly (1.4 to 1.7 in dam breaks measured), or
///   0.8 of that at which one of the bodies arrives, where that is more, for it is soon slower;
///   together (squared) with 1.25 times the speed of the fastest place of a moving obstacle (0.8 to
///   1.3 measured), and with sqrt(2 a L) for a tank in which the pull differs from gravity by a
///   along the longest side L (0.7 measured); at least sqrt(2 g d/20), a fall by a twentieth of the
///   spacing, as particles of a calm pool have (0.6 to 0.9 of it measured).
///   height: the highest of the start, with the speed of each body upwards; of the surface at rest
///   and twelve times e/g, for a part of the fluid may take the energy of the rest; of that surface
///   and 1.6 times the height from which a body falls; and of the solids, at all times.
/// Where fluid can leave through a side or the floor, it rests at the floor. A body from a file
/// counts as spread over the domain: `particles` less those of the others.
/// Without gravity there is no height to tell: infinite.
Reach reach_of(const Scene& scene, const Double3& up, std::int64_t particles);

/// The obstacles at a time (s since the start), lengths in m along the scene's axes.
std::vector<Solid<double>> solids_in_metres(const Scene& scene, double time);

/// A body of fluid outside of the obstacles and within the domain. Heights: m along `up`.
struct Parcel {
  double volume = 0;  ///< m^3
  double height = 0;  ///< of the centre of mass
  double top = -1e300;
  Double3 velocity{};  ///< m/s
};

/// A volume that has come to rest.
struct Rest {
  double height = 0;   ///< m, of the centre of mass
  double surface = 0;  ///< m
};

/// The domain in cells, those in obstacles left out; `solids` in m.
class StartVolume {
 public:
  StartVolume(const Scene& scene, const Double3& up, const std::vector<Solid<double>>& solids);
  /// One per body; of a body from a file an even share of the domain, with what `particles` has
  /// besides the others.
  std::vector<Parcel> parcels(std::int64_t particles) const;
  /// A volume (m^3) that fills the domain from the floor on.
  Rest at_rest(double volume) const;
  double floor() const { return low_; }  ///< m, of the lowest corner

 private:
  Double3 corner(const std::array<int, 3>& cell) const;
  bool is_open(const Double3& place) const;
  Parcel of_block(const scene_module::Body& body) const;
  Parcel of_shape(const scene_module::Body& body) const;

  const Scene& scene_;
  Double3 up_, edge_{};  ///< of a cell, m
  const std::vector<Solid<double>>& solids_;
  std::array<int, 3> cells_{};
  std::vector<char> open_;      ///< of each cell
  std::vector<double> layers_;  ///< m^3 in each of equal slices of the heights
  double low_ = 0, high_ = 0;   ///< m, heights of the lowest and the highest corner
};

}  // namespace pbf::render_module
