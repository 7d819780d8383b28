// checkpoint.h5: the whole state of a run in working precision, so that a resumed run gives the
// same bits. The previous checkpoint is kept as checkpoint_prev.h5.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lib/program/time_levels.h"
#include "lib/solver/diagnostics.h"
#include "lib/solver/solver_state.h"
#include "lib/solver/split_rows.h"

namespace pbf::io_module {

/// A run as it stands after some update.
struct SavedRun {
  SolverState state;
  EnergyHistory energy;        ///< of the measures that are due until then
  double compression_max = 0;  ///< 1, largest of the measures that are due until then
  Diagnostics first;           ///< of the run: what guard_limits() needs of it, lib/run/guard.h
  std::optional<StepHistory> steps;     ///< with time.adaptive
  std::optional<double> released;       ///< J, Guard::released()
  std::int64_t compressed_updates = 0;  ///< RunWarnings::compressed_updates()
  std::int64_t particles = 0;           ///< of `state`, or of the rows that are elsewhere
  std::string path;                     ///< of the file, where they are in it
  std::string scene;  ///< resolved_yaml() of the run, and files_text() of the files that it names;
  std::string files;  ///< both empty in checkpoints of older versions
};

/// Rows of a piece in which a state is written or read: whole chunks of the file.
inline constexpr std::int64_t kCheckpointRows = std::int64_t{1} << 18;
/// Gives a state in such pieces.
using GiveState = std::function<void(const StateSink& to)>;

/// Writes `folder`/checkpoint.h5 by way of checkpoint.h5.tmp, which has reached the disk before it
/// takes the place of the one before. Throws Error(io), having left the checkpoints as they were.
/// pieces: null, or gives the state, with ids in order, in place of saved.state.
void write_checkpoint(const std::string& folder, const SavedRun& saved,
                      const GiveState& pieces = nullptr);

/// The newest checkpoint of a folder; nothing when there is none. One that is damaged (every part
/// carries a checksum) is told in `notes` and the one before is taken; Error(io) when no other is
/// there. rows: whether they are kept; without, they are read and checked as well, piece by piece,
/// and `path` names the file for CheckpointRows. Such a file has ids in order.
std::optional<SavedRun> read_checkpoint(const std::string& folder, std::vector<std::string>& notes,
                                        bool rows = true);

/// The rows of a checkpoint that read_checkpoint() has read.
class CheckpointRows {
 public:
  explicit CheckpointRows(const SavedRun& saved) : path_(saved.path) {}
  /// So many from `first` on, with the fields of as many rows. Throws Error(io).
  SolverState read(std::int64_t first, std::int64_t rows) const;

 private:
  const std::string path_;
};

}  // namespace pbf::io_module
