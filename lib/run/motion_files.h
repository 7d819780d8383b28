// Reads the files of prescribed motions, and chooses the step of `time.step: auto` with them.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::run_module {

/// Reads the tables of the scene's motions. `dir` anchors relative paths. Throws Error(bad_input)
/// with key, file and line for an invalid table, for times that do not increase, and for a table
/// that ends before time.motion_begin + time.end; Error(io). `auto_step`: time.step was auto and is
/// now chosen from the motions (choose_step_of_motions()).
void read_motions(Scene& scene, const std::string& dir, bool auto_step = false);

/// Chooses time.step from gravity, bodies and motions, after the tables have been read: the fastest
/// obstacle moves by at most kSafeWay h in a step, and the acceleration of a particle at rest in
/// the tank takes the place of gravity. Covers a whole period or table, whatever time.end is.
/// Throws Error(bad_input) if nothing moves, and if the scene violates a rule with this step.
void choose_step_of_motions(Scene& scene);

/// The paths of these files, as written in the scene.
std::vector<std::string> motion_paths(const Scene& scene);

/// The files as read by read_motions().
std::vector<SceneFile> motion_files(const Scene& scene);

/// Makes their paths absolute, as read_motions() found them, so that the scene may be moved.
void make_paths_absolute(Scene& scene);

}  // namespace pbf::run_module
