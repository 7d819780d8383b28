// The implementation of RunWriter: all HDF5 calls that write run.vtkhdf.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lib/base/stage_clock.h"
#include "lib/io/h5_output.h"
#include "lib/io/run_file.h"
#include "lib/io/run_layout.h"
#include "lib/solver/split_rows.h"

namespace pbf::io_module {

/// A run file being written. Used, made and destroyed under an h5::Lock. Members throw h5::Failure
/// when HDF5 or the disk fails and Error(internal) when a frame does not fit the ones before;
/// after either the object may only be destroyed, which leaves the file as the last commit left it.
class RunOutput {
 public:
  /// As those of RunWriter.
  RunOutput(const std::string& path, const RunInfo& info, bool gzip);
  RunOutput(const std::string& path, const RunInfo& info, bool gzip, std::int64_t frames,
            const KeptRows& rows);
  ~RunOutput();
  /// Appends a frame, and commits what is not yet: from then on a killed process leaves it
  /// readable. Soon after another commit it leaves that to later calls, or to commit().
  void write_frame(const Snapshot& snapshot);
  void commit();
  /// A frame in steps, for rows that are elsewhere. begin_frame() makes room for a frame, of which
  /// `head` has no bytes and the ids 0, 1, 2 ...; `chunks` are empty in a file with compression.
  /// There rows() writes them, in whole chunks. commit_frame() is to be called when all rows are on
  /// the disk or written by rows().
  FramePlaces begin_frame(const Snapshot& head);
  void rows(std::size_t field, std::int64_t first, const FieldArray& rows);
  void commit_frame();
  std::uint64_t inode() const;
  /// Keeps the row until the next commit: a frame, close, or enough rows or seconds gathered.
  void log(const LogRow& row);
  void gauges(const GaugeRow& row);
  /// Commits, writes what waits, and waits until the disk has stored it.
  void sync();
  /// The same with the end of the session.
  void close(const RunEnding& ending);
  std::int64_t frames() const { return frames_; }  ///< committed
  std::int64_t bytes() const { return bytes_; }    ///< size of the file at the last commit

 private:
  RunOutput(const RunInfo& info, bool gzip);

  struct Field {
    std::string name, unit;
    ScalarType type;
    int components;
    h5::Column data;     // /VTKHDF/Points or /VTKHDF/PointData/<name>
    h5::Column offsets;  // /VTKHDF/Steps/PointDataOffsets/<name>; closed for Points
  };
  /// Rows that are written together.
  template <class Row>
  struct Waiting {
    std::vector<Row> rows{};
    Stopwatch since{};
    bool add(Row row) {  // whether they are many, or have waited long
      if (rows.empty()) since.reset();
      rows.push_back(std::move(row));
      return rows.size() >= run_layout::waiting_rows ||
             since.seconds() > run_layout::waiting_seconds;
    }
  };
  struct Topology {  // one of Vertices, Lines, Polygons, Strips
    h5::Column cells, ids, ends;
  };

  /// The column at `path`: made, or while `opening_` opened and cut to `rows` rows.
  h5::Column column(hid_t parent, const std::string& path, hid_t type, const h5::Layout& layout,
                    hsize_t rows) const;
  h5::Column offsets(const std::string& field, hsize_t frames) const;
  void make_tables(hsize_t frames);
  void make_ids(ScalarType type, hsize_t frames, hsize_t ids, hsize_t rows);
  void make_log(hsize_t frames, hsize_t rows);
  void make_bodies(hsize_t frames);
  void check_bodies(const Snapshot& snapshot, bool split) const;
  void write_bodies(const Snapshot& snapshot);
  void make_gauges(hsize_t rows);
  void write_gauges();
  void write_info(const RunInfo& info);
  void write_warnings(const std::vector<std::string>& warnings);
  void write_comparisons(const std::vector<StoredComparison>& comparisons);
  void make_sessions();
  void begin_session(const RunInfo& info);
  void end_session(const std::string& reason, std::int64_t last_update);
  void open_steps(std::int64_t frames);
  void open_fields(std::int64_t frames);
  void open_further(hsize_t rows);
  void create_fields(const Snapshot& first);
  /// The first row behind so many in a chunk of its own: what a frame has written no later one
  /// touches.
  hsize_t whole_chunks(hsize_t rows) const {
    return (rows + chunk_rows_ - 1) / chunk_rows_ * chunk_rows_;
  }
  void check_fields(const Snapshot& snapshot, bool split) const;
  /// All of a frame but its commit. places: null, or what to fill in instead of writing rows.
  void add_frame(const Snapshot& snapshot, FramePlaces* places);
  std::int64_t part_of(std::size_t count);
  std::int64_t write_ids(const Snapshot& snapshot, bool split);
  void commit_if_due();
  void set_steps(std::int64_t frames);  // NSteps
  void write_log();
  void write_further();
  void flush();
  void store();  // flushes, and waits for the disk

  h5::File file_;  // first: destroyed last
  bool gzip_, opening_ = false, closed_ = false;
  bool longer_ = false;    // the file, since the disk has stored its size
  bool in_steps_ = false;  // a frame has begun, and its rows may be missing
  std::int64_t frames_ = 0, added_ = 0, bytes_ = 0;  // frames: committed, and all
  std::optional<Stopwatch> since_commit_;
  std::size_t expected_;  // particles at most, from RunInfo
  ScalarType id_type_ = ScalarType::i32;
  h5::Group vtk_, steps_, pbf_;
  std::vector<Field> fields_;
  hsize_t chunk_rows_ = 1, end_row_ = 0, numbered_ = 0;  // numbered_: rows of the ids 0, 1, 2 ...
  hsize_t frame_row_ = 0;                                // the first of the last frame
  h5::Column ids_, id_offsets_, connectivity_, points_per_part_, updates_;
  std::array<Topology, 4> topologies_;
  std::vector<std::int64_t> parts_;  // particles of each part; frames of the same number share it
  std::vector<double> last_times_ = std::vector<double>(run_layout::step_rows);  ///< s, last chunk
  h5::Column times_, part_offsets_, part_counts_, point_offsets_, cell_offsets_, id_starts_;
  const std::vector<std::string> body_names_;
  h5::Column bodies_;                         ///< closed in a run without free bodies
  const std::vector<ReadingColumn> columns_;  ///< of readings
  std::vector<h5::Column> gauges_;            ///< time, update, then those of the gauges
  Waiting<std::vector<double>> waiting_gauges_;
  Waiting<LogRow> waiting_;
  std::map<std::string, h5::Column> log_, further_, sessions_;
};

}  // namespace pbf::io_module
