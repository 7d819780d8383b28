// The stability suite: stiff and extreme scenes, each with a required result, run and checked.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/grid.h"
#include "lib/io/table.h"
#include "lib/run/monitor.h"
#include "lib/run/start.h"

namespace pbf::campaign_module {

/// Requirements of a case. In addition, unless an error or the guard must end the run: all
/// particles are finite and inside, none is lost, and the guard does not stop the run.
struct Criteria {
  std::optional<double> speed;  ///< m/s, largest in any measurement
  double energy = 0.03;  ///< rise above the start and released_energy(), share of energy_scale()
  std::optional<double> compression_mean;  ///< mean over the settled part: the last quarter
  std::optional<double> compression_max;   ///< largest in the settled part
  std::optional<double> nearest;           ///< least distance of two particles at the end, spacings
  std::optional<double> still;  ///< kinetic energy at the end, share of energy_scale() at the start
  std::optional<double> height;       ///< relative loss of height of the center of mass
  std::optional<double> momentum;     ///< drift, relative to sqrt(2 M E) with the kinetic energy E
  std::optional<double> penetration;  ///< h, largest in walls and obstacles in any measurement
  std::optional<double> through;      ///< net particles through any flow gauge in any measurement
  std::optional<double> loads;  ///< imbalance of loads, relative to the weight: load_imbalance()
  std::string like;             ///< name of a case with the same center of mass at the end, in h
  std::optional<int> error;     ///< exit code of the error that must end it before the first update
  std::string says;             ///< what that error's text must contain
  std::string warns;            ///< text that a warning of the scene must contain
  std::string guard;  ///< "": must not stop; an alarm's name: must stop it; "allowed": either
};

/// One case of a suite file.
struct StabilityCase {
  std::string name, group, about;
  std::string scene;  ///< path
  Settings set;       ///< settings of the case
  Settings small;     ///< additional settings for the reduced size
  Criteria must;
};

/// Reads a suite file (configs/stability.yaml explains the format), strictly.
/// Throws Error(bad_input) with one line per problem.
std::vector<StabilityCase> read_stability_suite(const std::string& path);

/// One criterion: fulfilled when value <= limit (value >= limit for `nearest`).
struct StabilityCheck {
  std::string name;
  double value = 0, limit = 0;
  bool good = false;
};

/// Figures of a run for tables.
struct Figures {
  std::int64_t particles = 0, updates = 0;
  double speed_max = 0, energy_rise = 0;  ///< m/s; share of Course::scale
  /// Over the last quarter of the measurements.
  double compression_mean = 0, compression_max = 0;
};

struct StabilityRow : Figures {
  std::string name, group, must, happened;
  bool good = false;
  double used = 0;       ///< largest ratio of a value to its limit; below 1 if the case passes
  std::string tightest;  ///< the criterion with this ratio
  std::vector<StabilityCheck> checks;  ///< empty if the run did not reach its end
  std::int64_t fast = 0;
  double dt_hat = 0;  ///< relative_step(), lib/scene/auto_step.h
  double nearest = 0;
  Double3 center{};  ///< center of mass at the end, in h from the domain's lower corner
  double seconds = 0;
};

struct StabilityOptions {
  bool reduced = false;
  Backend backend = Backend::cpu;
  Precision precision = Precision::single;
  int threads = 0;                     ///< per case; 0: all
  std::vector<std::string> overrides;  ///< --set, applied after the case's own
  std::string base_folder;             ///< as in load_scene()
  std::function<bool()> stop;          ///< called between updates; true stops the runs
};

/// Without output, and where and with what the options say.
void without_files(Scene& scene, const StabilityOptions& o);

/// Runs one case and judges it, except for `like`. Throws Error(unavailable) if the backend is
/// missing; any other error counts for the verdict. Empty if o.stop() ended it.
std::optional<StabilityRow> run_stability_case(const StabilityCase& c, const StabilityOptions& o);

/// Largest distance of two centers of mass that count as alike, h.
constexpr double kLikeness = 0.1;

/// Judges `like` of every row against the row of the named case.
void judge_likeness(const std::vector<StabilityCase>& cases, std::vector<StabilityRow>& rows);

/// Quantities of a run that the criteria use.
struct Course : Figures {
  Diagnostics first, last;
  double scale = 0;        ///< J, energy_scale() at the start
  double released = 0;     ///< released_energy(), share of scale
  double penetration = 0;  ///< m, largest in walls and obstacles in any measurement
  double through = 0;      ///< kg, largest total of a flow gauge in any measurement
  double impulse[3]{};     ///< N s, of all loads since the start
  std::optional<GuardEvent> event;
  std::string guard_text;
  std::optional<StepHistory> steps;  ///< with time.adaptive; its `updates` until the end
};

/// Runs a scene under its guard to the end or to an alarm; `done` gets the solver at the end. Empty
/// if stop(), called between updates, returned true.
std::optional<Course> run_course(Start start, const std::function<bool()>& stop = {},
                                 const std::function<void(Solver&)>& done = {});

/// Least distance of two particles, in the unit of `x` (3 per particle); infinite for one particle.
double nearest_distance(const std::vector<double>& x);

/// Two lines for users: the verdict, the requirements of the case, and what happened.
std::string stability_text(const StabilityRow& r);

/// One row per case.
Table stability_table(const std::vector<StabilityRow>& rows, const StabilityOptions& o);

/// JUnit XML with a test case per case. seconds: of the whole suite, wall time.
std::string stability_junit(const std::vector<StabilityRow>& rows, const StabilityOptions& o,
                            double seconds);

}  // namespace pbf::campaign_module
