// The path of an obstacle during a run, and how far two obstacles overlap.
#pragma once

#include <array>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Interval along an axis of the scene, in h from its origin.
struct Extent {
  double low, high;
  bool meets(const Extent& other) const { return low <= other.high && other.low <= high; }
};
using Extents = std::array<Extent, 3>;

/// Extents along the axes; infinite for a plane.
Extents extents_of(const Solid<double>& solid);

/// The domain in the same form.
Extents extents_of(const Scene& scene);

/// Poses of an obstacle at times of the run, which include all extremes of its motion. Between two
/// times it moves by at most a spacing, unless that takes more than kLongestTrack times.
struct Track {
  std::vector<double> time;  ///< s since the start, from 0 to time.end; only 0 if it is fixed
  std::vector<Solid<double>> solid;
  Extents swept;  ///< union over all times
};
inline constexpr int kLongestTrack = 4096;
/// The tracks of all obstacles. With very many obstacles, each has fewer times.
std::vector<Track> tracks_of(const Scene& scene);

/// The obstacle at a time, s since the start.
Solid<double> solid_at(const Scene& scene, const Obstacle& obstacle, double time);

/// Thickness of the overlap of two solids in the domain, h: the diameter of its largest inscribed
/// ball; 0 if below `least`. The solids are convex, so descent finds the center of this ball.
double shared_thickness(const Scene& scene, const Solid<double>& a, const Solid<double>& b,
                        double least);

}  // namespace pbf::inline run_module
