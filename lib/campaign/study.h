// A study: many runs of one scene with different values of some keys, their errors and run times.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/front.h"
#include "lib/data/comparison.h"
#include "lib/scene/scene.h"

namespace pbf::campaign_module {

/// One run of a study.
struct StudyMember {
  std::string variant;              ///< its name; empty without variants
  std::vector<std::string> values;  ///< of Study::keys, as written in the file
  Scene scene;
  double energy_limit = 0;  ///< largest energy_rise of a valid run: of its variant or of the study
  /// "consistent solver.iterations=4", for users: the variant and the first key of each grid entry.
  std::string label;
};

/// A quantity of motion, as a column of MemberResult::log. Its error is the difference from the
/// reference over time.
struct MotionError {
  std::string column;  ///< "energy", "gauge/H2", "gauge/U/x"
  std::string unit;    ///< as in the log: "J"

  std::string rms() const;       ///< of its columns in the table: "energy_rms_J"
  std::string relative() const;  ///< "energy_rms_relative"
  std::string order() const;     ///< "energy_order"
};

/// A study file with the checked scene of every member.
struct Study {
  std::string name, path;
  std::string scene_dir;          ///< anchors the paths of file bodies
  std::vector<std::string> keys;  ///< varied by the grid
  bool has_variants = false;
  std::vector<StudyMember> members;
  std::optional<StudyMember> reference;         ///< the run that motion is compared with
  std::optional<std::size_t> reference_member;  ///< its number, if it is one of the members
  std::string reference_key;                    ///< "study.yaml:9:12: reference", for messages
  std::vector<std::string> errors{"compression_mean"};  ///< measures; the first one's front is
                                                        ///< marked
  std::vector<MotionError> motion;                      ///< compared with the reference
  std::vector<DataComparison> comparisons;              ///< with measurements, of the scene
  std::vector<double> targets{0.01, 0.001};             ///< of the errors
  double from = 0;                                      ///< s, earlier measurements are ignored
  double energy_limit = 0.01;  ///< for members whose variant has no own limit
  int repeats = 3;             ///< of the timing; the whole run is the first
  bool cpu_clock = false;      ///< seconds are CPU time of the process, not wall time
  std::optional<Front> front;
};

/// Reads a study file (`pbf study --help` lists the keys). `overrides` (as for a run) apply to
/// every member, before its variant and grid. Throws Error(bad_input) with one line per problem,
/// "study.yaml:7:5: key: what"; the scenes of members are checked, too.
Study load_study(const std::string& path, const std::vector<std::string>& overrides,
                 const std::string& base_folder = {});

/// The measures that can be plotted against run time; `errors` are some of them.
std::vector<std::string> study_error_measures(const Study& study);

/// The readings that a result holds: those of gauges, and loads.
std::vector<ReadingColumn> stored_readings(const Scene& scene);
/// The column of MemberResult::log of a number of one: "gauge/H2", "gauge/U/x",
/// "load/post/force_x".
std::string stored_column(const ReadingColumn& column, int component);

/// The columns of MemberResult::log that not every run has: stored_readings(), and `work` where
/// something moves.
struct FurtherColumn {
  std::string name;  ///< "gauge/H2", "gauge/U/x", "work", "load/post/force_x"
  const char* unit;
};
std::vector<FurtherColumn> further_columns(const Scene& scene);

/// The stored result of a run. NaN is null in the file.
struct MemberResult {
  std::string status = "finished";  ///< or diverged: not finite, or outside the box
  std::string message;              ///< the reason, if it is not finished
  std::string backend, precision, device;
  std::int64_t threads = 0, particles = 0, updates = 0;
  double seconds = 0;          ///< s, of all updates, without measurements and the start
  std::vector<double> ratios;  ///< of short repeats: time relative to the same updates of the run
  /// Of measurements, as that of run.vtkhdf, with further_columns(): gauges are read when the run
  /// is measured.
  std::map<std::string, std::vector<double>> log;

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
/// and throws Error(bad_input) for an invalid one, or one without a column of a run of `scene`.
void write_member(const std::string& path, const MemberResult& result);
std::optional<MemberResult> read_member(const std::string& path, const Scene& scene = {});

}  // namespace pbf::campaign_module
