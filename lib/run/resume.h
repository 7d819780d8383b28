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

/// The processes that worked on a run before.
struct EarlierSessions {
  std::int64_t sessions = 0;
  double seconds = 0;  ///< of wall time, all of them
  bool whole = true;   ///< false: one was killed, and nobody knows when
};

struct ResumePoint {
  bool finished = false;          ///< done up to the end that the scene asks for; notes say it
  bool started = false;           ///< there is something to go on with; else everything is new
  std::optional<SavedRun> saved;  ///< the state to go on from; absent: the start
  bool keep_file = false;         ///< go on in run.vtkhdf; else it is written anew
  std::int64_t frames = 0;        ///< of run.vtkhdf that stay: the run would write the same
  KeptRows rows;                  ///< of the log and of gauges, that stay
  std::optional<EarlierSessions> earlier;  ///< that run.vtkhdf knows of
  std::vector<std::string> notes;          ///< what the user should know
  std::int64_t update() const { return saved ? saved->state.updates : 0; }
};

/// Looks at a folder that this process has locked. `files`: of the scene, as they were read;
/// `commit`: of this program. Throws Error(bad_input) naming the key, or the file, when the scene
/// and its files are not those that the folder's run was begun with, or that its checkpoint or
/// run.vtkhdf is of (only what physics_difference() leaves out may change); Error(io) when a
/// checkpoint cannot be read.
ResumePoint find_resume_point(const RunFolder& folder, const Scene& scene,
                              const std::vector<SceneFile>& files, std::int64_t particles,
                              const std::string& commit);

/// Makes the folder ready to go on: removes DONE, and moves a damaged run.vtkhdf aside.
void prepare_resume(const RunFolder& folder, const ResumePoint& from);

}  // namespace pbf::inline run_module
