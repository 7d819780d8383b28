// Compares two run files: the files, the matching frames, and the parts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/verify/compare.h"

namespace pbf::verify_module {

/// A run file with values that are needed several times.
struct ComparedRun {
  std::string path;
  RunReader reader;
  RunInfo info;
  Scene scene;
  std::vector<double> times;  ///< of frames, s
  std::string status;
  /// Throws Error(io) if the file cannot be read, Error(bad_input) if its scene cannot.
  explicit ComparedRun(const std::string& path);
  /// Frame k. Throws Error(io) if its arrays do not have the shape of a frame, or ids do not
  /// ascend.
  Snapshot frame(std::int64_t k) const;
  /// The status, with the reason if the session gives one.
  std::string end_text() const;
};

/// Frames of A and B at the same time, within half an update, and the unpaired ones.
struct FramePairs {
  std::vector<std::pair<std::int64_t, std::int64_t>> common;
  std::vector<double> only_a, only_b;  ///< s
};
FramePairs pair_frames(const ComparedRun& a, const ComparedRun& b);

/// Compares metadata: status, end, frames, fields, rows of the log. Anything in only one of the
/// files is a difference.
ComparePart compare_extents(const ComparedRun& a, const ComparedRun& b, const FramePairs& frames);

/// Parts "particles" and "distributions" over the common frames. `exact`: both sides promise
/// identical bits.
std::vector<ComparePart> compare_frames(const ComparedRun& a, const ComparedRun& b,
                                        const FramePairs& frames, bool exact,
                                        CompareResult& result);

}  // namespace pbf::verify_module
