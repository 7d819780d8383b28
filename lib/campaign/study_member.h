// One run of a study: simulates, measures the time, stores the result.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/study.h"
#include "lib/solver/solver.h"

namespace pbf::campaign_module {

/// The stored result of a run. NaN is null in the file.
struct MemberResult {
  std::string status = "finished";  ///< or diverged: not finite, or outside the box
  std::string message;              ///< the reason, if it is not finished
  std::string backend, precision, device;
  std::int64_t threads = 0, particles = 0, updates = 0;
  double seconds = 0;          ///< s, of all updates, without measurements and the start
  std::vector<double> ratios;  ///< of short repeats: time relative to the same updates of the run
  std::map<std::string, std::vector<double>> log;  ///< of measurements, as that of run.vtkhdf

  const std::vector<double>& series(const std::string& name) const;
  double seconds_median() const;  ///< s
  double seconds_spread() const;  ///< s, longest minus shortest repeat
};

/// Identifies a result by what it depends on: program, machine, resolved scene, particle files and
/// repeats. Members with the same key are the same run.
std::string member_key(const Study& study, const StudyMember& member);

/// Runs a member. `stop` is called between updates; empty if it returned true. `progress` gets the
/// completed share, 0 to 1. Throws what the solver throws.
std::optional<MemberResult> run_member(const Study& study, const StudyMember& member,
                                       const std::function<bool()>& stop,
                                       const std::function<void(double)>& progress);

/// Write and read the result as JSON. write throws Error(io). read is empty if there is no file,
/// and throws Error(bad_input) for an invalid one.
void write_member(const std::string& path, const MemberResult& result);
std::optional<MemberResult> read_member(const std::string& path);

}  // namespace pbf::campaign_module
