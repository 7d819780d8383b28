// Warnings about where obstacles go. Parts of scene_warnings(). `tracks`: tracks_of() the scene.
#pragma once

#include <string>
#include <vector>

#include "lib/run/obstacle_track.h"
#include "lib/run/warnings.h"

namespace pbf::inline run_module {

/// "obstacles[0] (gate)"
std::string named(const Scene& scene, std::size_t obstacle);
/// Up to three of them, and how many more.
std::string listed(const std::vector<std::string>& texts);

/// Kind "table": the curve of a table swings beyond the rows on both sides where no smooth motion
/// turns back, by more than a tenth of a spacing; or its first row puts the obstacle elsewhere, as
/// a table of places does in the place of displacements.
void add_tables(const Scene& scene, std::vector<Warning>& list);

/// Kind "wall": a motion carries an obstacle through a wall by more than a spacing, or out of the
/// tank. What cuts a wall from the start (a paddle that goes on behind it) may go to and fro in it;
/// what turns about a hinge at a wall may dip into that; and nothing is said of the wall against
/// gravity, through which gates are lifted, nor of planes, nor of what begins outside and comes in.
void add_walls(const Scene& scene, const std::vector<Track>& tracks, std::vector<Warning>& list);

/// Kind "collision": two obstacles share a place in the domain, at the start or later, that is
/// thicker than half a spacing. A plane with something set into it from the start is a floor.
void add_collisions(const Scene& scene, const std::vector<Track>& tracks,
                    std::vector<Warning>& list);

}  // namespace pbf::inline run_module
