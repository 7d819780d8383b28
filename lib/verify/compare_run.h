// Compares two run files: the files, the matching frames, and the parts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/verify/compare.h"

namespace pbf::inline verify_module {

/// A run file with what is asked of it more than once.
struct ComparedRun {
  std::string path;
  RunReader reader;
  RunInfo info;
  Scene scene;
  std::vector<double> times;  ///< of frames, s
  std::string status;
  /// Throws Error(io) for a file that cannot be read, Error(bad_input) for a scene in it that
  /// cannot.
  explicit ComparedRun(const std::string& path);
  /// Frame k. Throws Error(io) where its arrays have not the shape of a frame.
  Snapshot frame(std::int64_t k) const;
  /// The status, with the reason where the session gives another one.
  std::string end_text() const;
};

/// Frames of A and B at the same time, to half an update, and the others.
struct FramePairs {
  std::vector<std::pair<std::int64_t, std::int64_t>> common;
  std::vector<double> only_a, only_b;  ///< s
};
FramePairs pair_frames(const ComparedRun& a, const ComparedRun& b);

/// What the files say about themselves: status, end, frames, fields, rows of the log. What only one
/// of them holds is a difference.
ComparePart compare_extents(const ComparedRun& a, const ComparedRun& b, const FramePairs& frames);

/// Parts "particles" and "distributions" over the common frames. `exact`: both sides promise the
/// same bits.
std::vector<ComparePart> compare_frames(const ComparedRun& a, const ComparedRun& b,
                                        const FramePairs& frames, bool exact,
                                        CompareResult& result);

}  // namespace pbf::inline verify_module
