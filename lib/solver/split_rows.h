// Rows of a solver whose particles are on several ranks. No rank has memory for all of them: they
// stay where they are, or go to and from rank 0 in pieces.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lib/scene/periodic.h"
#include "lib/solver/snapshot.h"
#include "lib/solver/solver.h"
#include "lib/solver/solver_state.h"

namespace pbf::solver_module {

/// Where the rows of a frame have room in a file. Row i of a field is in chunk i / chunk_rows.
struct FramePlaces {
  std::int64_t chunk_rows = 1;
  /// For each field of a snapshot but the ids: bytes from the start of the file to each chunk.
  std::vector<std::vector<std::uint64_t>> chunks{};
};

/// Displacements of particles, h.
struct Moves {
  double squares = 0, farthest = 0;  ///< sum of squares; largest
  /// From a to b, both of 3n coordinates. The sum is in the order of the particles. period: h, of
  /// periodic axes, 0 of others.
  void add(const std::vector<double>& a, const std::vector<double>& b, const Double3& period = {}) {
    for (std::size_t k = 0; k < a.size(); k += 3) {
      double squared = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = shortest(b[k + c] - a[k + c], period[c]);
        squared += d * d;
      }
      squares += squared;
      farthest_squared_ = std::max(farthest_squared_, squared);
    }
    farthest = std::sqrt(farthest_squared_);
  }

 private:
  double farthest_squared_ = 0;
};

/// Rows of one field from `first` on, in the order of ids.
using TakeRows = std::function<void(std::int64_t first, FieldArray&& rows)>;

/// Takes a state in pieces.
struct StateSink {
  /// First: all but the rows of particles. Fields of particles have no values.
  std::function<void(SolverState&& head)> head;
  /// Then the rows from `first` on, in the order of ids, with the fields of particles alone.
  std::function<void(std::int64_t first, SolverState&& rows)> rows;
};
/// Gives one in pieces.
struct StateSource {
  SolverState head;        ///< as above; values of fields of particles are ignored
  std::int64_t count = 0;  ///< particles
  /// So many rows from `first` on, in any order of ids, with the fields of particles.
  std::function<SolverState(std::int64_t first, std::int64_t rows)> read;
};

/// Called on rank 0. Errors are thrown as Error, on every rank.
class SplitRows {
 public:
  virtual ~SplitRows() = default;

  /// Copies like Solver::download(), once earlier copies have been written. Each rank keeps rows of
  /// a range of ids. Returns a snapshot whose `count` is that of all particles and whose fields
  /// have no bytes.
  virtual Snapshot hold(const std::vector<std::string>& fields, ScalarType type) = 0;
  /// The rows of field number `field` that are held, in pieces of `most`.
  virtual void held(std::size_t field, std::int64_t most, const TakeRows& take) = 0;
  /// Whether all ranks see the file `path` (absolute) that rank 0 writes; inode: its number. After
  /// that they may write to it.
  virtual bool share_file(const std::string& path, std::uint64_t inode) = 0;
  /// Every rank begins to write the rows that it holds to the shared file, on a thread of its own.
  virtual void write_held(const FramePlaces& places) = 0;
  /// Whether the disks have stored all that was written; waits for that if it shall. Throws
  /// Error(io) if something could not be written.
  virtual bool written(bool wait) = 0;

  /// The rows come in pieces of `most`.
  virtual void state_in_pieces(StateOf which, std::int64_t most, const StateSink& to) = 0;
  virtual void set_state_in_pieces(const StateSource& from) = 0;
  /// set_state(state(StateOf::kept)); rows stay on their ranks.
  virtual void go_back() = 0;
  /// The displacements since the last call of this function; none in the first call.
  virtual Moves moves() = 0;
};

}  // namespace pbf::solver_module
