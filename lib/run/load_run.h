// Loads the input of `pbf run`: a scene file, or a run file whose scene is run again.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/load.h"
#include "lib/scene/scene_files.h"

namespace pbf::run_module {

/// For a scene file: load_scene(), with the same `base_folder`. For a run file (recognized by its
/// first bytes) or its folder (lib/io/run_path.h): the stored scene, with the defaults of that time
/// and the present overrides. Its paths are relative to the folder of the original scene file or,
/// if the files are no longer there, to that of the run file; the tables of its motions are read.
/// Throws what load_scene() and RunReader throw; Error(bad_input) if the scene of a run file has
/// been changed since, or if its files are in neither folder.
LoadedScene load_scene_or_run(const std::string& given, const std::vector<std::string>& overrides,
                              const std::string& base_folder = {});

/// The folder that anchors the paths of a run file's scene: that of its scene file, or that of the
/// run file. Throws Error(bad_input) if the files are in neither.
std::string folder_of_files(const Scene& scene, const std::string& run_file,
                            const std::string& scene_path);

/// Reads what obstacles and motions of a run's scene name, and makes the tables of its waves; the
/// files of bodies need not be there. Throws as folder_of_files() and read_linked_files().
void read_files_of_run(Scene& scene, const std::string& run_file, const std::string& scene_path);

/// Stores in `loaded` which files were read, for the run. For a scene from a run file they must be
/// the files of that run: Error(bad_input) names one that has changed. If an older run file has no
/// record of them, a line is added to `notes`. Files that --set names are not compared.
void take_files(LoadedScene& loaded, const std::vector<SceneFile>& read,
                std::vector<std::string>& notes);

}  // namespace pbf::run_module
