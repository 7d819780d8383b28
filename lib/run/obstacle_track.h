// Where an obstacle goes in the course of a run, and how far two of them reach into each other.
#pragma once

#include <array>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Lengths in h from the scene's origin, along its axes.
struct Extent {
  double low, high;
  bool meets(const Extent& other) const { return low <= other.high && other.low <= high; }
};
using Extents = std::array<Extent, 3>;

/// From where to where it reaches along the axes; a plane everywhere.
Extents extents_of(const Solid<double>& solid);

/// The domain, as an obstacle's extents.
Extents extents_of(const Scene& scene);

/// An obstacle at some times of the run. In between it goes on by no more than a spacing, unless it
/// goes farther than kLongestTrack of them, and all its extremes are among them.
struct Track {
  std::vector<double> time;  ///< s since the start, from 0 to time.end; of one that stands 0
  std::vector<Solid<double>> solid;
  Extents swept;  ///< of all of them together
};
inline constexpr int kLongestTrack = 4096;
/// Of every obstacle. Where there are very many, they are looked at less often.
std::vector<Track> tracks_of(const Scene& scene);

/// The obstacle as it is at a time.
Solid<double> solid_at(const Scene& scene, const Obstacle& obstacle, double time);

/// How thick what two solids share in the domain is, h: the diameter of the largest ball in it. 0
/// where that is less than `least`. They are convex, so the way to its middle is downhill.
double shared_thickness(const Scene& scene, const Solid<double>& a, const Solid<double>& b,
                        double least);

}  // namespace pbf::inline run_module
