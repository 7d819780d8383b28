// What --resume finds in a run folder, and where the run goes on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/run_folder.h"
#include "lib/io/checkpoint.h"
#include "lib/scene/load.h"

namespace pbf {

struct ResumePoint {
  bool finished = false;           ///< the run is done up to the end that the scene asks for
  bool started = false;            ///< there is something to go on with; else everything is new
  std::optional<SavedRun> saved;   ///< the state to go on from; absent: the start
  bool keep_file = false;          ///< go on in run.h5; else it is written anew
  std::int64_t frames = 0;         ///< of run.h5 that stay: the run would write the same
  std::int64_t rows = 0;           ///< of the log that stay
  std::vector<std::string> notes;  ///< what the user should know
  std::int64_t update() const { return saved ? saved->state.updates : 0; }
};

/// Looks at a folder that this process has locked. `dir`: folder of the scene's particle files;
/// `commit`: of this program. Throws
/// Error(bad_input) naming the key when the scene is not the one that the folder's run was begun
/// with (only what physics_difference() leaves out may change), or its end lies before what is
/// done; Error(io) when a checkpoint cannot be read.
ResumePoint find_resume_point(const RunFolder& folder, const Scene& scene, const std::string& dir,
                              std::int64_t particles, const std::string& commit);

/// By what the scene of a record (scene.resolved.yaml) and its particle files differ from `scene`;
/// empty when by nothing that matters.
std::string difference_of_record(const LoadedScene& record, const Scene& scene,
                                 const std::string& dir);

/// scene.resolved.yaml of a run folder: the scene, and a hash of the particle files that it names
/// (`dir`: their folder), so that a run is not resumed with other particles.
std::string scene_record(const Scene& scene, const std::string& dir);

/// Makes the folder ready to go on: removes DONE, and moves a damaged run.h5 aside.
void prepare_resume(const RunFolder& folder, const ResumePoint& from);

}  // namespace pbf
