// The run file run.vtkhdf: a temporal VTKHDF PolyData file plus our own root group /pbf.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lib/program/column.h"
#include "lib/scene/scene.h"
#include "lib/solver/diagnostics.h"
#include "lib/solver/snapshot.h"
#include "lib/solver/solver.h"
#include "lib/solver/split_rows.h"

namespace pbf::io_module {

/// The run file in its folder: .vtkhdf is what ParaView knows.
inline constexpr const char* kRunFile = "run.vtkhdf";
/// Where one that cannot be gone on with is kept.
inline constexpr const char* kDamagedRunFile = "run.damaged.vtkhdf";
/// Its name in earlier versions.
inline constexpr const char* kEarlierRunFile = "run.h5";

/// One process that worked on a run: started it, or resumed it. A row of the tables in
/// /pbf/sessions.
struct RunSession {
  std::string started, ended;  ///< ISO 8601, UTC; ended is empty while it runs or when killed
  std::string reason;          ///< finished, SIGTERM, --max-walltime, diverged ...; as `ended`
  std::string host, device, program;  ///< program: version (commit)
  std::int64_t threads = 0;
  std::int64_t first_update = 0, last_update = 0;  ///< where it began and ended
};

/// Everything about a run that is known before its first update; goes to /pbf as attributes.
struct RunInfo {
  std::string scene_path, scene_text, resolved_scene;
  std::vector<std::string> overrides;
  std::vector<std::string> warnings;  ///< so far: those of the scene; at the end those of the run
  std::string program_version, commit, compiler, build_flags;
  std::string host, started;  ///< ISO 8601, UTC
  std::string plan;           ///< text of the plan
  std::string scene_sha256;   ///< scene_digest(), lib/scene/scene_files.h; empty in older files
  std::string scene_files;    ///< files_text() of the files that the scene names; the same
  std::string scene_bases;    ///< files_text() of those that its file builds on; the same
  SolverInfo solver;
  Double3 domain_min{}, domain_max{};
  double spacing = 0, smoothing_length = 0, rest_density = 0;
  /// J, of the fluid at rest on the floor (lib/program/energy_at_rest.h); NaN: nothing holds it.
  double energy_at_rest = std::numeric_limits<double>::quiet_NaN();
  std::int64_t particles = 0;          ///< at the start
  std::int64_t capacity = 0;           ///< at any time, where the number changes; 0: it does not
  std::int64_t first_update = 0;       ///< of this session
  std::vector<ReadingColumn> columns;  ///< of readings; is not read back
  /// Names of the free bodies, in the order of Snapshot::bodies.
  std::vector<std::string> bodies{};
};

/// The result of an entry of `compare` (lib/data/comparison.h).
struct StoredComparison {
  struct Number {
    std::string name, unit;
    double value = 0;  ///< NaN: there is none
  };
  std::string name;
  std::vector<Number> numbers{};
  /// What was compared with what: attributes by name ("data", "column", "sha256", "note" ...).
  std::vector<std::pair<std::string, std::string>> texts{};
};

/// What is known when a run ends.
struct RunEnding {
  std::string status{};  ///< finished, stopped, diverged
  std::string reason{};  ///< of the session's end; empty: the status
  std::int64_t last_update = 0;
  std::vector<std::string> warnings{};          ///< all of the run, in place of RunInfo::warnings
  std::vector<StoredComparison> comparisons{};  ///< in place of those that the file has
};

/// One row of the log: the measures, and the seconds per stage since the row before.
struct LogRow {
  Diagnostics measures;
  int iterations = 0;
  double dt = 0;                  ///< s, of the steps of the update that the measure follows
  std::vector<StageTime> stages;  ///< the same names in every row of a run
  std::vector<double> poses{};    ///< of Series::poses
};

/// The readings of Series::gauges after an update.
struct GaugeRow {
  std::int64_t update = 0;
  double time = 0;  ///< s
  std::vector<double> numbers;
};

/// Rows that stay in a file that is gone on with.
struct KeptRows {
  std::int64_t log = 0, gauges = 0;
};

/// Writes run.vtkhdf from a thread of its own; all HDF5 calls of the writer happen there.
/// Errors of that thread (disk full) are thrown as Error(io) by the next call from outside.
class RunWriter {
 public:
  /// Creates the file (fails if it exists). gzip: shuffle + deflate level 1.
  RunWriter(const std::string& path, const RunInfo& info, bool gzip);
  /// Goes on in a file that a stopped or killed run has left: the first `frames` frames and `rows`
  /// of the log and the gauges are kept, what lies behind them is dropped.
  RunWriter(const std::string& path, const RunInfo& info, bool gzip, std::int64_t frames,
            const KeptRows& rows);
  ~RunWriter();
  /// Queues a frame of any particles; blocks while more than 2 wait. A frame is durable (on the
  /// disk, readable after kill -9 and after a power cut) once frames_written() counts it, at most
  /// twice run_layout::commit_seconds after it was written.
  void write(Snapshot&& snapshot);
  /// The same for a frame whose rows are elsewhere (lib/solver/split_rows.h): makes room for it,
  /// once all that was queued is done. Its ids are 0, 1, 2 ... `chunks` are empty in a file with
  /// compression, whose rows are given to rows(), in whole chunks.
  FramePlaces begin_frame(const Snapshot& head);
  /// Rows of field number `field` without the ids. Blocks while more than 2 pieces wait.
  void rows(std::size_t field, std::int64_t first, FieldArray&& rows);
  /// When all rows have been given to rows() or stored by others: queues the end of the frame.
  void commit_frame();
  std::uint64_t inode();  ///< of the file
  void log(const LogRow& row);
  void gauges(const GaugeRow& row);
  std::int64_t frames_written() const;
  std::int64_t bytes_written() const;
  /// Waits until all that was queued, the log too, is on the disk.
  void sync();
  /// Waits for the queue, writes /pbf status ("finished", "stopped", "diverged") with the end of
  /// the session, and closes.
  void finish(const RunEnding& ending);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Has a child process read all of a run file but its frames: Error(io) for one on which HDF5
/// crashes or does not come to an end. For files from elsewhere, before a RunReader.
void try_run_file(const std::string& path);

/// Where the frames of a run file are.
struct FrameTable {
  struct Field {
    std::string name, unit, path;  ///< path under /VTKHDF
    std::vector<std::int64_t> offsets{};
    ScalarType type = ScalarType::f32;
    int components = 1;
  };
  std::vector<double> times{};
  std::vector<std::int64_t> counts{}, updates{};
  std::vector<Field> fields{};  ///< position first; those of PointData
  std::int64_t bodies = 0;      ///< free bodies in every frame
};

/// Readings over time; vectors one behind the other.
struct RunColumn {
  std::vector<double> values{};  ///< empty: the file has no such column
  int components = 1;
  std::string unit{}, kind{};  ///< kind: of a gauge ("level")
};

/// Reads a run file, also one still being written or cut off. Throws Error(io) with the reason.
class RunReader {
 public:
  explicit RunReader(const std::string& path);
  std::int64_t frames() const { return std::int64_t(in_.times.size()); }
  std::vector<double> times() const { return in_.times; }            ///< s
  std::vector<std::int64_t> counts() const { return in_.counts; }    ///< particles of each frame
  std::vector<std::int64_t> updates() const { return in_.updates; }  ///< of each frame
  std::vector<std::string> fields() const;                           ///< without position and id
  /// Frame k (0-based) with all its fields, "position" first, and its bodies; Error(bad_input) when
  /// out of range.
  Snapshot frame(std::int64_t k) const;
  std::vector<BodyMotion> bodies(std::int64_t k) const;  ///< of frame k alone
  RunInfo info() const;
  std::string status() const;                ///< running, finished, stopped, diverged
  std::vector<RunSession> sessions() const;  ///< empty in files of older versions
  /// One column of the log ("compression_mean", "stage/lambda", ...); empty when not there.
  std::vector<double> log_column(const std::string& name) const;
  std::vector<std::string> log_columns() const;
  /// All columns by name, opening the file once.
  std::map<std::string, std::vector<double>> log() const;
  /// A column of readings by its path below /pbf: "gauges/H2", "log/load/post/force_x".
  RunColumn column(const std::string& path) const;
  std::vector<StoredComparison> comparisons() const;
  /// Data below /pbf/gauges ("time", "update", "H1", "peak/P1"); none where the run has no gauges.
  std::vector<std::string> gauges() const;
  /// Readings of one of them, vectors one behind the other; as many as all have. Empty when not
  /// there.
  std::vector<double> gauge(const std::string& name) const;

 private:
  void require_frame(std::int64_t k) const;

  std::string path_;
  FrameTable in_;
};

}  // namespace pbf::io_module
