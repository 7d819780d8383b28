// One run: a session and everything that its run folder contains.
#pragma once

#include <cstdio>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/run/resume.h"
#include "lib/run/start.h"
#include "lib/run/watch.h"
#ifdef PBF_HAS_RENDER
#include "lib/render/renderer.h"
#endif

namespace pbf::inline run_module {

/// A run: what it is made of, where it writes to, and what its observers find out.
struct RunParts {
  const Start& start;
  Solver& solver;
  Control& control;
  StageClock& clock;
  const RunFolder& folder;
  const ResumePoint& from;              ///< the solver has its state
  std::FILE* json = nullptr;            ///< one line per measure, null: none; owned by the caller
  std::unique_ptr<RunWriter> writer{};  ///< null: none
#ifdef PBF_HAS_RENDER
  std::unique_ptr<RenderThread> pictures{};  ///< the same; the caller's, made before the folder
#endif
  const LoadedScene& loaded = start.loaded;
  const Scene& scene = loaded.scene;
  const Plan& plan = start.plan;
  Log& log = control.log;
  const Stopwatch& wall = control.wall;
  Schedule schedule = make_schedule(scene);

  double loop_seconds = 0;     ///< s, the updates with their output
  double drawing_seconds = 0;  ///< s, spent drawing beside the run
  double compression_max = 0;  ///< largest over all measures
  std::int64_t frames_written = 0, pictures_drawn = 0, bytes = 0;
  std::string status{};       ///< as in run.vtkhdf: finished, stopped, diverged
  std::string stop_reason{};  ///< "SIGTERM", ...
};

/// Warnings of a run, told as they come up, and its progress.
class Reporter : public Observer {
 public:
  Reporter(RunParts& run, const Watch& watch);
  std::int64_t next(std::int64_t /*u*/) const override { return kEveryCall; }
  /// Each kind of warning once: at the end the whole run's figures are told.
  Now at(Session& session) override;
  void end(Session& session) override;
  /// To be given every measure that is due, in order.
  void follow(const Diagnostics& due);
  /// Counts the particles beyond open faces.
  void look_outside(const Snapshot& snapshot);
  /// Updates so far whose next measure found a mean compression above kNoLiquid.
  std::int64_t compressed_updates() const { return compressed_; }
  bool has_told() const { return !told_.empty(); }
  /// After the end: the warnings of the scene and of the whole run.
  const std::vector<Warning>& warnings() const { return all_; }
  /// What has not been told on the way, and what has become of the rest.
  std::vector<Warning> untold() const;

 private:
  template <class Coordinate>
  void count_outside(std::size_t n, const Coordinate& coordinate);
  std::vector<Warning> found(bool end) const;

  RunParts& run_;
  const Watch& watch_;
  Progress progress_;
  std::map<std::string, std::string> told_;  // kind, text
  std::vector<Warning> all_;
  std::int64_t compressed_ = 0, left_ = 0;
  double farthest_ = 0;  // m
  std::string faces_;    // through which they left
};

/// What is written down of the measures: rows of the log, lines of JSON, what a checkpoint holds.
class Rows {
 public:
  Rows(RunParts& run, Reporter& reporter);
  /// Fills in what the energy's track knows. Error(io) where the JSON cannot be written.
  void take(Diagnostics& m, double dt);
  /// The same for a measure whose row is there.
  void follow(Diagnostics& m) const { EnergyTrack(energy_).follow(m); }
  /// As of the last measure that is due, without a state.
  const SavedRun& due() const { return due_; }
  /// Seconds per stage. The names of the whole run from the start, so that every row of the log has
  /// the same columns.
  std::vector<StageTime> stages() const;

 private:
  std::vector<StageTime> stages_since_last_row();

  RunParts& run_;
  Reporter& reporter_;
  std::vector<StageTime> row_stages_;
  EnergyTrack energy_;
  SavedRun due_;
};

/// Copies frames and pictures from the solver where they are due, and hands them over; the last
/// frame, too.
class Frames : public Observer {
 public:
  Frames(RunParts& run, Reporter& reporter);
  std::int64_t next(std::int64_t u) const override { return run_.schedule.next_output(u); }
  Now at(Session& session) override;
  void end(Session& session) override;
  void close() noexcept override;
  /// Gives the copy that is under way, if any, to the writer and the pictures. On a device it runs
  /// beside the updates of a call of Solver::step(), after which this is due.
  void hand_over();

 private:
  void start(std::int64_t update, bool last);

  RunParts& run_;
  Reporter& reporter_;
  std::vector<std::string> fields_;  // downloaded
  std::string extra_;                // downloaded for the pictures, not written
  std::int64_t last_ = -1;           // update of the last one
  std::future<Snapshot> copy_;
  bool write_ = false, draw_ = false;  // what is under way
  std::int64_t picture_ = 0;           // its number, as in the name
};

/// Makes a run safe, and stops it on signals, at the wall-time limit and, a strict one, for a
/// warning. To be placed last.
class Saving : public Observer {
 public:
  Saving(RunParts& run, Frames& frames, const Rows& rows, Watch& watch, const Reporter& reporter)
      : run_(run), frames_(frames), rows_(rows), watch_(watch), reporter_(reporter) {}
  std::int64_t next(std::int64_t /*u*/) const override { return kAlways; }
  Now at(Session& session) override;
  void end(Session& session) override;

 private:
  std::string why_stop() const;
  bool save();

  RunParts& run_;
  Frames& frames_;
  const Rows& rows_;
  Watch& watch_;
  const Reporter& reporter_;
  Stopwatch since_save_;
};

/// The run file and the folder of the pictures, where there are some. started: UTC, ISO 8601.
void open_files(RunParts& run, const std::string& started);

/// Runs to the end, a signal, the wall-time limit or an alarm of the guard, writes the last frame,
/// closes every file, and tells the summary. Throws Error(guard) after an alarm, whose last good
/// state and a scene that goes on from it are saved; Error(difference) for the warnings of a strict
/// run; what writing and drawing throw.
void run_session(RunParts& run);

/// What there is to say at the end, in plain words: what each number is and what is good. With the
/// seconds per group of stages, in percent of the wall time; what no stage booked is "other".
std::string run_summary(const RunParts& run, const Watch& watch,
                        const std::vector<StageTime>& stages);

}  // namespace pbf::inline run_module
