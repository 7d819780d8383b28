// A study: many runs of one scene with different values of some keys, their errors and run times.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/front.h"
#include "lib/scene/scene.h"

namespace pbf::inline campaign_module {

/// One run of a study.
struct StudyMember {
  std::string variant;              ///< its name, empty without variants
  std::vector<std::string> values;  ///< of Study::keys, as written
  Scene scene;
  double energy_limit = 0;  ///< largest energy_rise of a valid run: its variant's or the study's
  /// "consistent solver.iterations=4", for people: the variant, the first key of each grid entry.
  std::string label;
};

/// A study file with every member's scene made and checked.
struct Study {
  std::string name, path;
  std::string scene_dir;          ///< anchors the paths of file bodies
  std::vector<std::string> keys;  ///< that the grid varies
  bool has_variants = false;
  std::vector<StudyMember> members;
  std::optional<StudyMember> reference;      ///< what the members' centres of mass are held against
  std::string error = "compression_mean";    ///< the measure set against the run time
  std::vector<double> targets{0.01, 0.001};  ///< of the error
  double from = 0;                           ///< s, measures before do not count
  double energy_limit = 0.01;                ///< of members whose variant has none of its own
  int repeats = 3;                           ///< of the timing, the whole run counts as one
  bool cpu_clock = false;                    ///< seconds are the process's CPU time, not the wall's
  std::optional<Front> front;
};

/// Reads a study file (`pbf study --help` has the keys). `overrides` as on the command line of a
/// run: they apply to every member, before its variant and grid. Throws Error(bad_input) with one
/// line per problem, "study.yaml:7:5: key: what"; scenes of members are checked too.
Study load_study(const std::string& path, const std::vector<std::string>& overrides,
                 const std::string& base_folder = {});

/// The measures of this study's table that can be set against time: `error` is one of them.
std::vector<std::string> study_error_measures(const Study& study);

}  // namespace pbf::inline campaign_module
