// The volume of a scene's fluid at the start, and where it lies once it is at rest.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf::render_module {

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
