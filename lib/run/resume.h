// Examines a run folder for --resume and finds the point at which the run continues.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/io/checkpoint.h"
#include "lib/io/run_file.h"
#include "lib/program/plan.h"
#include "lib/run/run_folder.h"
#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::run_module {

/// The earlier processes of a run.
struct EarlierSessions {
  std::int64_t sessions = 0;
  double seconds = 0;  ///< sum of their wall times
  bool whole = true;   ///< false: one was killed, so its end is unknown
};

struct ResumePoint {
  bool finished = false;          ///< complete up to time.end; see notes
  bool started = false;           ///< there is something to resume; otherwise the run starts anew
  std::optional<SavedRun> saved;  ///< the state to resume from; absent: the start
  bool keep_file = false;         ///< continue run.vtkhdf; otherwise write it anew
  std::int64_t frames = 0;        ///< of run.vtkhdf that stay, as the run would write the same
  KeptRows rows;                  ///< of the log and of gauges that stay
  std::optional<EarlierSessions> earlier;  ///< sessions that run.vtkhdf records
  std::vector<std::string> notes;          ///< messages for the user
  std::int64_t update() const { return saved ? saved->state.updates : 0; }
};

/// Examines a folder that this process has locked. `files`: files of the scene, as read; `commit`:
/// of this program. Throws Error(bad_input), with the key or the file, if scene or files differ
/// from those of the folder's run, its checkpoint or its run.vtkhdf (differences that
/// physics_difference() ignores are allowed); Error(io) if a checkpoint cannot be read.
ResumePoint find_resume_point(const RunFolder& folder, const Scene& scene,
                              const std::vector<SceneFile>& files, const Plan& plan,
                              const std::string& commit);

/// Prepares the folder for the run: removes DONE, and renames a damaged run.vtkhdf.
void prepare_resume(const RunFolder& folder, const ResumePoint& from);

}  // namespace pbf::run_module
