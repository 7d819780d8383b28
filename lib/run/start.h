// The one way into a run. prepare() reads the files of a scene and plans it; solver_of() makes a
// solver at its start, for commands that advance it themselves; run() does all that `pbf run` does.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lib/base/log.h"
#include "lib/data/comparison.h"
#include "lib/program/plan.h"
#include "lib/run/run_folder.h"
#include "lib/run/stop_token.h"
#include "lib/run/warnings.h"
#include "lib/scene/load.h"
#include "lib/scene/particles.h"
#include "lib/solver/solver.h"

namespace pbf::run_module {

/// The work that prepare() does.
struct PrepareOptions {
  bool fits = true;                   ///< refuse what the memory of this machine cannot hold
  bool warnings = false;              ///< of the scene
  bool strict = false;                ///< they are an error
  bool particles = true;              ///< are made
  bool measured = false;              ///< read what the scene's readings are compared with
  std::function<void()> when_read{};  ///< called before what takes long
  /// Gets lines about the progress of what takes long, at times from threads, one at a time.
  std::function<void(const std::string&)> progress{};
};

struct Start {
  LoadedScene loaded;
  Plan plan{};
  Particles particles{};    ///< on several ranks without positions and velocities
  ParticlePieces pieces{};  ///< on several ranks: these
  std::vector<Warning> warnings{};
  std::vector<DataComparison> comparisons{};  ///< with PrepareOptions::measured
  std::vector<std::string> notes{};           ///< changes to the particles, for the log
  const Scene& scene() const { return loaded.scene; }
};

/// Opens each particle file of the scene once. Its motions have been read (read_linked_files()).
/// Throws, in this order, what StartPoints, count_particles(), `when_read` and make_plan() throw,
/// what read_comparisons() throws, Error(unavailable) as refuse_if_too_large(), Error(difference)
/// for warnings where they are errors, and what emit_particles() throws.
Start prepare(LoadedScene loaded, const PrepareOptions& options = {});
/// The same for a scene without a file; `folder` anchors relative paths.
Start prepare(const Scene& scene, const std::string& folder, const PrepareOptions& options = {});

/// A solver of the particles of a start, which are moved into it, or of those on all ranks. scene,
/// plan: of the start, or others of the same particles. Throws as make_solver() and
/// make_ranked_solver() do.
std::unique_ptr<Solver> new_solver(Start& start, const Scene& scene, const Plan& plan);

/// A solver before its first update, after settle() and prestabilize(). The particles are moved
/// into it.
std::unique_ptr<Solver> solver_of(Start& start);

/// The output folder of a run.
struct RunPlace {
  std::string folder;
  ExistingFolder existing = ExistingFolder::refuse;
};

/// External control of a run.
struct Control {
  StopToken& stop;
  Log& log;
  std::string log_json{};   ///< file that gets a line of JSON per measurement; empty: none
  double max_walltime = 0;  ///< s, 0: none
  bool strict = false;      ///< a warning ends it
  Stopwatch wall{};         ///< since this was made

  /// Why the run has to stop; empty: it goes on.
  std::string why_stop() const {
    if (const char* why = stop.why()) return why;
    return max_walltime > 0 && wall.seconds() >= max_walltime ? "--max-walltime" : "";
  }
};

/// How a run ended, if nothing was thrown.
struct RunResult {
  std::string stop_reason;   ///< "SIGTERM", "--max-walltime"; empty: finished
  std::int64_t updates = 0;  ///< done
};

/// Throws Error(unavailable) for a scene with pictures in a build that draws none, as run() does:
/// to be asked before prepare() takes its time.
void refuse_pictures(const Scene& scene);
/// Runs into a folder, or goes on with the run there. Its lines go to control.log and the folder's
/// log.txt, an error that ends it to log.txt. A scene that cannot run leaves no folder behind.
/// Several runs may be under way in one process, each with a folder, a token and a log of its own;
/// inputs() (lib/base/inputs.h) are those of all of them.
/// Throws as run_session(), RunFolder, find_resume_point(), take_files() and make_solver() do.
RunResult run(Start start, const RunPlace& place, Control& control);

}  // namespace pbf::run_module
