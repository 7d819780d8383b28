// Reads the files of prescribed motions.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline run_module {

/// Reads the tables of the scene's motions. `dir` anchors relative paths. Throws Error(bad_input)
/// naming key, file and line for what is no such table, for times that do not grow, and where the
/// table does not last from time.motion_begin for time.end; Error(io). `auto_step`: time.step was
/// left to be chosen, and is, now that the motions are known (choose_step_of_motions()).
void read_motions(Scene& scene, const std::string& dir, bool auto_step = false);

/// The paths of these files, as the scene has them.
std::vector<std::string> motion_paths(const Scene& scene);

/// The files, as read_motions() has read them.
std::vector<SceneFile> motion_files(const Scene& scene);

/// Their paths replaced by what read_motions() found there, so that the scene may lie anywhere.
void make_paths_absolute(Scene& scene);

}  // namespace pbf::inline run_module
