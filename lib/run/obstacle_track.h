// The path of an obstacle during a run, and how far two obstacles overlap.
#pragma once

#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/body_box.h"

namespace pbf::run_module {

/// The extents of a solid along the axes of the scene, in h from its origin; infinite for a plane,
/// and along y of a scene in two dimensions.
BodyBox extents_of(const Scene& scene, const Solid<double>& solid);

/// The domain in the same form.
BodyBox extents_of(const Scene& scene);

/// Poses of an obstacle at times of the run, which include all extremes of its motion. Between two
/// times it moves by at most a spacing, unless that takes more than kLongestTrack times.
struct Track {
  std::vector<double> time;  ///< s since the start, from 0 to time.end; only 0 if it is fixed
  std::vector<Solid<double>> solid;
  BodyBox swept;  ///< union over all times
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

}  // namespace pbf::run_module
