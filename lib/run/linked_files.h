// The files that obstacles and motions of a scene name. Those of bodies: emit.h.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::run_module {

/// Reads tables of motions, makes those of waves (wave_files.h), and reads surfaces of obstacles,
/// each file once. `dir` anchors relative paths. Throws what read_motion() (motion_files.h) and
/// read_surface() (surface_files.h) throw. auto_step: time.step was auto and is now chosen from the
/// motions (choose_step_of_motions()).
void read_linked_files(Scene& scene, const std::string& dir, bool auto_step = false);

/// The paths of these files, as written in the scene.
std::vector<std::string> linked_paths(const Scene& scene);

/// The files as read by read_linked_files().
std::vector<SceneFile> linked_files(const Scene& scene);

/// Makes their paths absolute, as they were found, so that the scene may be moved.
void make_paths_absolute(Scene& scene);

}  // namespace pbf::run_module
