// What a run folder says of the scene that it was made with, held against the scene of today.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/load.h"
#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline run_module {

/// scene.resolved.yaml of a run folder: the scene, and files_text() of the particle files that it
/// names, so that a run is not resumed with other particles.
std::string scene_record(const Scene& scene, const std::string& files);

/// files_text() from the comments that scene_record() begins with.
std::string recorded_files(const std::string& record);

/// By which keys (physics_difference()) and particle files two runs differ; empty when by none that
/// matters. `files_before`: a files_text().
std::string difference_of_runs(const Scene& before, const std::string& files_before,
                               const Scene& now, const std::vector<SceneFile>& files);

/// By what the scene of a record (scene.resolved.yaml) and its particle files differ from `scene`
/// and its files as they are now; empty when by nothing that matters.
std::string difference_of_record(const LoadedScene& record, const Scene& scene,
                                 const std::vector<SceneFile>& files);

/// By which key the run of a folder's run.vtkhdf is another than that of `scene`; empty when by
/// none that matters (physics_difference()), and when there is no such file that can be read.
std::string difference_of_file(const std::string& folder, const Scene& scene);

/// Why the run.vtkhdf of a folder with DONE is not a finished run up to the end of `scene`:
/// missing, not to be read, not finished, shorter. Empty when it is, or when the scene writes none.
std::string why_not_finished(const std::string& folder, const Scene& scene);

}  // namespace pbf::inline run_module
