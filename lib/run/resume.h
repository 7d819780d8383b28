// Examines a run folder for --resume and finds the point at which the run continues.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/io/checkpoint.h"
#include "lib/io/run_file.h"
#include "lib/run/run_folder.h"
#include "lib/scene/load.h"
#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline run_module {

struct ResumePoint {
  bool finished = false;           ///< the run is done up to the end that the scene asks for
  bool started = false;            ///< there is something to go on with; else everything is new
  std::optional<SavedRun> saved;   ///< the state to go on from; absent: the start
  bool keep_file = false;          ///< go on in run.vtkhdf; else it is written anew
  std::int64_t frames = 0;         ///< of run.vtkhdf that stay: the run would write the same
  KeptRows rows;                   ///< of the log and of gauges, that stay
  std::vector<std::string> notes;  ///< what the user should know
  std::int64_t update() const { return saved ? saved->state.updates : 0; }
};

/// Looks at a folder that this process has locked. `files`: of the scene, as they were read;
/// `commit`: of this program. Throws Error(bad_input) naming the key, or the file, when the scene
/// and its files are not those that the folder's run was begun with, or that its checkpoint or
/// run.vtkhdf is of (only what physics_difference() leaves out may change), or when the end lies
/// before what is done; Error(io) when a checkpoint cannot be read.
ResumePoint find_resume_point(const RunFolder& folder, const Scene& scene,
                              const std::vector<SceneFile>& files, std::int64_t particles,
                              const std::string& commit);

/// By what the scene of a record (scene.resolved.yaml) and its particle files differ from `scene`
/// and its files as they are now; empty when by nothing that matters.
std::string difference_of_record(const LoadedScene& record, const Scene& scene,
                                 const std::vector<SceneFile>& files);

/// scene.resolved.yaml of a run folder: the scene, and files_text() of the particle files that it
/// names, so that a run is not resumed with other particles.
std::string scene_record(const Scene& scene, const std::string& files);

/// Makes the folder ready to go on: removes DONE, and moves a damaged run.vtkhdf aside.
void prepare_resume(const RunFolder& folder, const ResumePoint& from);

/// By which key the run of a folder's run.vtkhdf is another than that of `scene`; empty when by
/// none that matters (physics_difference()), and when there is no such file that can be read.
std::string difference_of_file(const std::string& folder, const Scene& scene);

/// Why the run.vtkhdf of a folder with DONE is not a finished run up to the end of `scene`:
/// missing, not to be read, not finished, shorter. Empty when it is, or when the scene writes none.
std::string why_not_finished(const std::string& folder, const Scene& scene);

}  // namespace pbf::inline run_module
