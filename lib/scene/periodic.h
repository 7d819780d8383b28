// Periodic axes: their lengths, and distances between places that are joined through their faces.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// The axes of domain.periodic, ascending, without y in two dimensions.
inline std::vector<int> periodic_axes(const Scene& s) {
  std::vector<int> axes;
  for (int a = 0; a < 3; ++a)
    if (s.domain.is_periodic(a) && !(s.dimensions == 2 && a == 1)) axes.push_back(a);
  return axes;
}
/// The length of the domain along each periodic axis, m; 0 along others.
inline Double3 periods(const Scene& s) {
  Double3 p{};
  for (const int a : periodic_axes(s))
    p[std::size_t(a)] = s.domain.max[std::size_t(a)] - s.domain.min[std::size_t(a)];
  return p;
}
/// Whether gravity drives fluid along a periodic axis, where it has no potential but does work.
inline bool has_drive(const Scene& s) {
  const std::vector<int> axes = periodic_axes(s);
  return std::any_of(axes.begin(), axes.end(),
                     [&](int a) { return s.gravity[std::size_t(a)] != 0; });
}
/// A displacement or the shortest of those that differ from it by whole periods.
inline double shortest(double displacement, double period) {
  return period > 0 ? std::remainder(displacement, period) : displacement;
}

}  // namespace pbf::scene_module
