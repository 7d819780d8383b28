// Frames of a run on several ranks: every rank writes its rows.
#pragma once

#include <functional>
#include <string>

#include "lib/io/run_file.h"
#include "lib/solver/split_rows.h"

namespace pbf::run_module {

/// One frame at a time is written while the run goes on. A file with compression, or one that not
/// all ranks see, is written by rank 0, in pieces.
class SplitFrames {
 public:
  /// path: of the file of `writer`. note: gets a line if rank 0 writes alone.
  SplitFrames(SplitRows& rows, RunWriter& writer, const std::string& path,
              const std::function<void(const std::string&)>& note);
  /// Begins to write what is held (SplitRows::hold()); the frame before has ended. look: gets all
  /// positions, in pieces; null: they are not wanted.
  void begin(const Snapshot& head, const TakeRows& look);
  /// Ends it if all ranks have written their rows; waits for that if it shall.
  void end(bool wait);

 private:
  SplitRows& rows_;
  RunWriter& writer_;
  bool shared_, under_way_ = false;
};

}  // namespace pbf::run_module
