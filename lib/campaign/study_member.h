// One run of a study: simulates, measures the time, stores the result.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/study.h"
#include "lib/solver/solver.h"

namespace pbf::inline campaign_module {

/// What is kept of a run. NaN in the file: null.
struct MemberResult {
  std::string status = "finished";  ///< or diverged: not finite, or outside of the box
  std::string message;              ///< why, of a status other than finished
  std::string backend, precision, device;
  std::int64_t threads = 0, particles = 0, updates = 0;
  double seconds = 0;          ///< s, of all updates, without measures and the start
  std::vector<double> ratios;  ///< of short repeats: their time over that of the same first updates
  /// The log of measures by the columns' names of run.vtkhdf.
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  const std::vector<double>& series(const std::string& name) const;
  double seconds_median() const;  ///< s
  double seconds_spread() const;  ///< s, the longest less the shortest repeat
};

/// What the result depends on: program, machine, resolved scene, particle files and repeats. Two
/// members with the same key are the same run.
std::string member_key(const Study& study, const StudyMember& member);

/// Runs a member. `stop` is asked between updates; when it says so the answer is empty. `progress`
/// gets the share done, 0 to 1. Throws what the solver throws.
std::optional<MemberResult> run_member(const Study& study, const StudyMember& member,
                                       const std::function<bool()>& stop,
                                       const std::function<void(double)>& progress);

/// The result in a file of JSON, and back. write throws Error(io). read is empty when there is no
/// file; Error(bad_input) for one that cannot be understood.
void write_member(const std::string& path, const MemberResult& result);
std::optional<MemberResult> read_member(const std::string& path);

}  // namespace pbf::inline campaign_module
