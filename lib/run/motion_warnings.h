// The paths of obstacles during a run (obstacle_track.cpp), and texts of warnings about them, which
// are empty where there is none: parts of scene_warnings().
#pragma once

#include <string>
#include <vector>

#include "lib/scene/overlap.h"

namespace pbf::run_module {

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

/// "obstacles[0] (gate)"
std::string named(const Scene& scene, std::size_t obstacle);
/// Texts of one kind that are told one by one; of the others only the number.
inline constexpr std::size_t kShown = 3;

/// Kind "table": the curve of a table overshoots the rows on both sides by more than a tenth of a
/// spacing where no smooth motion turns back; or its first row displaces the obstacle, as in a
/// table of positions instead of displacements.
std::string tables_text(const Scene& scene);

/// Kind "wall": a motion carries an obstacle through a wall by more than a spacing, or out of the
/// tank. An obstacle that cuts a wall from the start (a paddle that extends behind it) may move in
/// it, and one that rotates about a hinge at a wall may dip into it. Not checked: the wall opposite
/// to gravity, through which gates are lifted; planes; obstacles that come in from outside.
std::string walls_text(const Scene& scene, const std::vector<Track>& tracks);

/// Kind "collision": two obstacles overlap in the domain, at the start or later, by more than half
/// a spacing. A plane that overlaps another obstacle from the start is taken for a floor.
std::string collisions_text(const Scene& scene, const std::vector<Track>& tracks);

}  // namespace pbf::run_module
