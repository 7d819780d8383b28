// The loop of one run: updates, measures, frames, pictures, and when to stop.
#pragma once

#include <cstdio>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lib/base/log.h"
#include "lib/base/stage_clock.h"
#include "lib/io/checkpoint.h"
#include "lib/io/run_file.h"
#include "lib/program/plan.h"
#include "lib/run/run_report.h"
#include "lib/run/schedule.h"
#include "lib/run/warnings.h"
#include "lib/run/watch.h"
#include "lib/scene/scene.h"
#include "lib/solver/solver.h"
#ifdef PBF_HAS_RENDER
#include "lib/render/renderer.h"
#endif

namespace pbf::inline run_module {

/// Why a run ended; the name is the status in run.vtkhdf.
enum class RunEnd { finished, stopped, diverged };
const char* status_name(RunEnd end);

/// Where a loop writes to; null: not at all.
struct RunSinks {
  std::unique_ptr<RunWriter> writer;
#ifdef PBF_HAS_RENDER
  std::unique_ptr<RenderThread> pictures;
#endif
  std::FILE* json = nullptr;  ///< one line per measure; owned by the caller
  std::string checkpoints;    ///< folder
  std::string scene_files;    ///< LoadedScene::files, for checkpoints
};

/// What ends a run besides its own end, signals and the guard.
struct RunLimits {
  double walltime = 0;            ///< s, 0: none
  bool strict = false;            ///< a warning does
  std::vector<Warning> of_scene;  ///< that the scene has given
};

class RunLoop {
 public:
  /// `wall` has been running since the start of the command.
  RunLoop(const Scene& scene, const Plan& plan, Solver& solver, RunSinks sinks, Log& log,
          StageClock& clock, const Stopwatch& wall, const RunLimits& limits);

  /// Before run(): goes on from a state that the solver has already been given.
  void go_on_from(const SavedRun& saved);
  /// Before run(): the first frames are in the file.
  void keep_frames(std::int64_t frames) { kept_frames_ = frames; }

  /// Runs to the end, a signal, the wall-time limit or an alarm of the guard, then writes the last
  /// frame and closes every file. Errors of writing and drawing are thrown.
  RunEnd run();

  RunTotals totals() const;
  const std::string& stop_reason() const { return stop_reason_; }  ///< "SIGTERM", ...
  /// What the guard stopped the run for; null unless it did.
  const GuardEvent* guard_event() const {
    return watch_ && watch_->event() ? &*watch_->event() : nullptr;
  }
  const Guard& guard() const { return *watch_->guard(); }
  /// After run(): those of the scene and of the whole run.
  const std::vector<Warning>& warnings() const { return all_warnings_; }
  /// Whether a warning has been told with these words.
  bool told(const Warning& w) const;

 private:
  void outputs(std::int64_t update, bool last);
  /// Gives the snapshot that is being copied from the solver, if any, to the writer and the
  /// pictures.
  void hand_over();
  /// Into the log and the JSON file, unless it takes the run back. `judged`: by look().
  void measure(bool judged = true);
  void show(const Measures& m);  // the state that a resumed run begins with; its row is there
  void tell(const std::vector<Warning>& found);
  bool must_stop();
  bool checkpoint_due();
  void save();
  /// What the guard says to it.
  Verdict look(const Measures& m);
  void choose_step(std::int64_t update);
  void book_guard(const std::function<void()>& action);
  Watch& watch(const Measures& m);
  double step() const { return watch_ ? watch_->step() : scene_.time.step; }  // s, at present
  bool watched() const { return scene_.guard || scene_.time.adaptive; }
  bool goes_back() const { return watch_ && watch_->goes_back(); }
  std::vector<StageTime> stages() const;
  std::vector<StageTime> stages_since_last_row();
  void close(RunEnd end);

  const Scene& scene_;
  const Plan& plan_;
  Solver& solver_;
  RunSinks sinks_;
  Log& log_;
  StageClock& clock_;
  const Stopwatch& wall_;
  RunLimits limits_;
  Schedule schedule_;
  Progress progress_;
  std::vector<std::string> fields_;    // downloaded
  std::vector<std::string> extra_;     // downloaded for the pictures, not written
  std::vector<StageTime> row_stages_;  // at the last row of the log
  Measures first_, last_;
  EnergyTrack energy_;
  SavedRun due_;  // energy and compression of the measures that are due, for checkpoints
  Stopwatch since_save_;
  std::int64_t start_ = 0, kept_frames_ = 0, seen_frames_ = 0;  // first update; in the file; due
  double compression_max_ = 0, loop_seconds_ = 0, render_thread_ = 0;
  std::int64_t frames_ = 0, pictures_ = 0, bytes_ = 0, last_frame_ = -1, last_measure_ = -1;
  bool resumed_ = false, closed_ = false;
  std::optional<Watch> watch_;
  std::optional<StepHistory> steps_;  ///< that a resumed run begins with
  std::optional<double> released_;    ///< the same
  /// A download that was started and is finished after the next updates: on a device the copy
  /// runs beside them.
  struct UnderWay {
    std::future<Snapshot> copy;
    bool write = false, draw = false;
  } under_way_;
  std::string stop_reason_;
  RunWarnings warnings_;
  std::map<std::string, std::string> told_;  ///< kind, text
  std::vector<Warning> all_warnings_;
};

}  // namespace pbf::inline run_module
