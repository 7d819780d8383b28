// One run: a session and everything that its run folder contains.
#pragma once

#include <cstdio>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/program/energy_at_rest.h"
#include "lib/run/monitor.h"
#include "lib/run/resume.h"
#include "lib/run/split_frames.h"
#include "lib/run/start.h"
#ifdef PBF_HAS_RENDER
#include "lib/render/renderer.h"
#endif

namespace pbf::run_module {

/// A run: its parts, its output, and the findings of its observers.
struct RunParts {
  const Start& start;
  Solver& solver;
  Control& control;
  StageClock& clock;
  const RunFolder& folder;
  const ResumePoint& from;              ///< the solver already has its state
  std::FILE* json = nullptr;            ///< one line per measurement; null: none; not owned
  std::unique_ptr<RunWriter> writer{};  ///< null: none
#ifdef PBF_HAS_RENDER
  std::unique_ptr<RenderThread> pictures{};  ///< null: none; made by the caller before the folder
#endif
  const Scene& scene = start.scene();
  const Plan& plan = start.plan;
  Schedule schedule = make_schedule(scene);
  double at_rest = energy_at_rest(scene, plan);  ///< J

  double loop_seconds = 0;     ///< s, updates with their output
  double drawing_seconds = 0;  ///< s, spent drawing in parallel with the run
  double compression_max = 0;  ///< largest over all measurements
  std::int64_t frames_written = 0, pictures_drawn = 0, bytes = 0;
  std::string status{};                      ///< as in run.vtkhdf: finished, stopped, diverged
  std::string stop_reason{};                 ///< "SIGTERM", ...
  std::vector<StoredComparison> compared{};  ///< with measurements, at the end
};

/// Reports progress, and warnings of a run when they arise.
class Reporter : public Observer {
 public:
  Reporter(RunParts& run, const Monitor& monitor);
  std::int64_t next(std::int64_t /*u*/) const override { return kEveryCall; }
  /// Reports each kind of warning once; the end has the figures of the whole run.
  Next at(Session& session) override;
  void end(Session& session) override;
  /// Must be given every scheduled measurement, in order.
  void follow(const Diagnostics& due);
  /// Counts the particles beyond open faces, in pieces from row 0 on.
  void look_outside(std::int64_t first, const FieldArray& position);
  /// Updates so far whose next measurement showed a mean compression above kNoLiquid.
  std::int64_t compressed_updates() const { return compressed_; }
  bool has_told() const { return !told_.empty(); }
  /// After the end: the warnings of the scene and of the whole run.
  const std::vector<Warning>& warnings() const { return all_; }
  /// Warnings not reported during the run, and those whose text has changed since.
  std::vector<Warning> untold() const;

 private:
  template <class Coordinate>
  void count_outside(std::int64_t first, std::size_t n, const Coordinate& coordinate);
  std::vector<Warning> found(bool end) const;

  RunParts& run_;
  const Monitor& monitor_;
  Progress progress_;
  std::map<std::string, std::string> told_;  // kind, text
  std::vector<Warning> all_;
  std::int64_t compressed_ = 0, left_ = 0, seen_ = 0;
  double farthest_ = 0;                // m
  std::vector<std::int64_t> through_;  // each open face
  std::string faces_;                  // open faces through which particles left
};

/// Records measurements: rows of the log, lines of JSON, contents of a checkpoint.
class LogRows {
 public:
  LogRows(RunParts& run, Reporter& reporter);
  /// Fills in the values from the energy track. Throws Error(io) if the JSON cannot be written.
  void take(Diagnostics& m, double dt);
  /// The same for a measurement that already has a row.
  void follow(Diagnostics& m) const { EnergyTrack(energy_).follow(m); }
  /// As of the last scheduled measurement, without a state.
  const SavedRun& due() const { return due_; }
  /// Seconds per stage. The names are complete from the start, so that all rows of the log have the
  /// same columns.
  std::vector<StageTime> stages() const;

 private:
  std::vector<StageTime> stages_since_last_row();

  RunParts& run_;
  Reporter& reporter_;
  std::vector<StageTime> row_stages_;
  EnergyTrack energy_;
  SavedRun due_;
};

/// Copies frames, including the last one, and data for pictures from the solver when they are due,
/// and hands them over.
class Frames : public Observer {
 public:
  Frames(RunParts& run, Reporter& reporter);
  std::int64_t next(std::int64_t u) const override { return run_.schedule.next_output(u); }
  Next at(Session& session) override;
  void end(Session& session) override;
  void close() noexcept override;
  /// Waits until all frames have been given to the writer.
  void finish();
  /// Gives a pending copy to the writer and the pictures. On a device the copy runs in parallel
  /// with the updates of one call of Solver::step(); call this after that call.
  void hand_over();

 private:
  void start(std::int64_t update, bool last);
  void write_split(ScalarType type);

  RunParts& run_;
  Reporter& reporter_;
  std::vector<std::string> fields_;     // downloaded
  std::string extra_;                   // downloaded for the pictures, not written
  std::unique_ptr<SplitFrames> split_;  // on several ranks: writes frames
  std::int64_t last_ = -1;              // update of the last frame
  std::future<Snapshot> copy_;
  bool write_ = false, draw_ = false;  // uses of the pending copy
  std::int64_t picture_ = 0;           // number in the file name
};

/// Writes checkpoints, and stops the run on signals, at the wall-time limit and, if it is strict,
/// for a warning. Must be the last observer.
class Saving : public Observer {
 public:
  Saving(RunParts& run, Frames& frames, const LogRows& rows, Monitor& monitor,
         const Reporter& reporter)
      : run_(run), frames_(frames), rows_(rows), monitor_(monitor), reporter_(reporter) {}
  std::int64_t next(std::int64_t /*u*/) const override { return kAlways; }
  Next at(Session& session) override;
  void end(Session& session) override;

 private:
  std::string why_stop() const;
  bool save();

  RunParts& run_;
  Frames& frames_;
  const LogRows& rows_;
  Monitor& monitor_;
  const Reporter& reporter_;
  Stopwatch since_save_;
};

/// The run file and the folder of the pictures, where there are some. started: UTC, ISO 8601.
void open_files(RunParts& run, const std::string& started);

/// Runs to the end, a signal, the wall-time limit or an alarm of the guard, writes the last frame,
/// closes all files and reports the summary. Throws Error(guard) after an alarm, with the last good
/// state and a scene that continues from it saved; Error(difference) for the warnings of a strict
/// run; what writing and drawing throw.
void run_session(RunParts& run);

/// The report at the end, in plain words: each number with its meaning and what is good; seconds
/// per group of stages, in percent of the wall time. Time of no stage is "other".
std::string run_summary(const RunParts& run, const Monitor& monitor,
                        const std::vector<StageTime>& stages);

/// One JSON object on one line: measurements, wall-clock seconds, frames that are safely on disk,
/// seconds per stage. `columns`: of the run's readings; `poses`: pose_readings().
std::string measure_json(const Diagnostics& measures, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages,
                         const std::vector<ReadingColumn>& columns,
                         const std::vector<double>& poses);

/// Percentage of `part` in `whole`; 0 if `whole` is 0.
inline double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

}  // namespace pbf::run_module
