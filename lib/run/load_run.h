// Loads the input of `pbf run`: a scene file, or a run file whose scene is run again.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/load.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline run_module {

/// load_scene() of a scene file, `base_folder` as there; of a run file (told by its first bytes),
/// or of the folder that it is in (lib/io/run_path.h), the scene that it holds, with every default
/// as it was then, and the overrides of this time on top. Paths in it are those of the scene file
/// that the run was begun with, or, where its files are not there any more, of the run file's
/// folder; the tables of its motions are read. Throws as load_scene() and RunReader do;
/// Error(bad_input) for a run file whose scene has been changed since, or whose files are in
/// neither folder.
LoadedScene load_scene_or_run(const std::string& given, const std::vector<std::string>& overrides,
                              const std::string& base_folder = {});

/// The folder from which all files of a run file's scene can be reached: that of its scene file, or
/// the run file's. Error(bad_input) where it is neither.
std::string folder_of_files(const Scene& scene, const std::string& run_file,
                            const std::string& scene_path);

/// Keeps what was read of the scene's files, for the run to come. Of a scene from a run file they
/// must be those of that run: Error(bad_input) names the one that has changed; that an older run
/// file says nothing of them goes to `notes`. Files that --set names now are new.
void take_files(LoadedScene& loaded, const std::vector<SceneFile>& read,
                std::vector<std::string>& notes);

}  // namespace pbf::inline run_module
