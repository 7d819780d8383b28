// Reads the files of prescribed motions.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline run_module {

/// Reads the tables of the scene's motions. `dir` anchors relative paths. Throws Error(bad_input)
/// with key, file and line for an invalid table, for times that do not increase, and for a table
/// that ends before time.motion_begin + time.end; Error(io). `auto_step`: time.step was auto and is
/// now chosen from the motions (choose_step_of_motions()).
void read_motions(Scene& scene, const std::string& dir, bool auto_step = false);

/// The paths of these files, as written in the scene.
std::vector<std::string> motion_paths(const Scene& scene);

/// The files as read by read_motions().
std::vector<SceneFile> motion_files(const Scene& scene);

/// Makes their paths absolute, as read_motions() found them, so that the scene may be moved.
void make_paths_absolute(Scene& scene);

}  // namespace pbf::inline run_module
