// Warnings about paths of obstacles. Parts of scene_warnings(). `tracks`: of tracks_of().
#pragma once

#include <string>
#include <vector>

#include "lib/run/obstacle_track.h"
#include "lib/run/warnings.h"

namespace pbf::run_module {

/// "obstacles[0] (gate)"
std::string named(const Scene& scene, std::size_t obstacle);
/// The first three texts, and the number of the others.
std::string listed(const std::vector<std::string>& texts);

/// Kind "table": the curve of a table overshoots the rows on both sides by more than a tenth of a
/// spacing where no smooth motion turns back; or its first row displaces the obstacle, as in a
/// table of positions instead of displacements.
void add_tables(const Scene& scene, std::vector<Warning>& list);

/// Kind "wall": a motion carries an obstacle through a wall by more than a spacing, or out of the
/// tank. An obstacle that cuts a wall from the start (a paddle that extends behind it) may move in
/// it, and one that rotates about a hinge at a wall may dip into it. Not checked: the wall opposite
/// to gravity, through which gates are lifted; planes; obstacles that come in from outside.
void add_walls(const Scene& scene, const std::vector<Track>& tracks, std::vector<Warning>& list);

/// Kind "collision": two obstacles overlap in the domain, at the start or later, by more than half
/// a spacing. A plane that overlaps another obstacle from the start is taken for a floor.
void add_collisions(const Scene& scene, const std::vector<Track>& tracks,
                    std::vector<Warning>& list);

}  // namespace pbf::run_module
