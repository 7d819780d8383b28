// The record of a run folder's scene, and its comparison with the present scene.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::run_module {

/// Contents of scene.resolved.yaml: the scene, and files_text() of the particle files that it
/// names, so that a run is not resumed with other particles.
std::string scene_record(const Scene& scene, const std::string& files);

/// files_text() from the comments at the beginning of scene_record().
std::string recorded_files(const std::string& record);

/// The keys (physics_difference()) and particle files in which two runs differ; empty if no
/// difference matters. `files_before`: a files_text().
std::string difference_of_runs(const Scene& before, const std::string& files_before,
                               const Scene& now, const std::vector<SceneFile>& files);

/// The key in which the run of a folder's run.vtkhdf differs from that of `scene`; empty if no
/// difference matters (physics_difference()), and if there is no readable file.
std::string difference_of_file(const std::string& folder, const Scene& scene);

/// Why the run.vtkhdf of a folder with DONE is not a finished run up to the end of `scene`:
/// missing, unreadable, not finished, shorter. Empty if it is one, or if the scene writes none.
std::string why_not_finished(const std::string& folder, const Scene& scene);

}  // namespace pbf::run_module
