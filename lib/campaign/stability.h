// The stability suite: stiff and extreme scenes, each with a required result, run and checked.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lib/campaign/grid.h"
#include "lib/run/start.h"
#include "lib/run/watch.h"

namespace pbf::inline campaign_module {

/// What must happen in a case. Always, unless an error or the guard must end it: every particle is
/// finite and inside, none is lost, and the guard does not stop the run.
struct Criteria {
  std::optional<double> speed;  ///< m/s, fastest particle of any measure
  double energy = 0.03;  ///< rise above the start and released_energy(), share of energy_scale()
  std::optional<double> compression_mean;  ///< mean over the settled part: the last quarter
  std::optional<double> compression_max;   ///< largest in the settled part
  std::optional<double> nearest;           ///< least distance of two particles at the end, spacings
  std::optional<double> still;  ///< kinetic energy at the end, share of energy_scale() at the start
  std::optional<double> height;       ///< loss of the centre of mass's height along gravity, share
  std::optional<double> momentum;     ///< drift, share of what the particles' momenta add up to
  std::optional<double> penetration;  ///< h, deepest in a wall or an obstacle at any measure
  std::optional<double> through;      ///< net through any flow gauge at any measure, particles
  std::optional<double> loads;  ///< balance of all loads, share of the weight: load_imbalance()
  std::string like;  ///< name of a case whose centre of mass at the end, in h, this one shares
  std::optional<int> error;  ///< exit code of the error that must end it before the first update
  std::string says;          ///< what that error's text must contain
  std::string warns;         ///< what a warning of the scene must contain
  std::string guard;  ///< "": must not stop; an alarm's name: must stop it; "allowed": either
};

/// One case of a suite file.
struct StabilityCase {
  std::string name, group, about;
  std::string scene;  ///< path
  Settings set;       ///< keys replaced
  Settings small;     ///< and these as well in the reduced size
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

/// What of a run stands in tables.
struct Figures {
  std::int64_t particles = 0, updates = 0;
  double speed_max = 0, energy_rise = 0;  ///< m/s; share of Course::scale
  /// Of the last quarter of the measures, or of the last state with new lists where that is more.
  double compression_mean = 0, compression_max = 0;
};

struct StabilityRow : Figures {
  std::string name, group, must, happened;
  bool good = false;
  double used = 0;       ///< largest value over its limit: below 1 where the case is good
  std::string tightest;  ///< the criterion that this is of
  std::vector<StabilityCheck> checks;  ///< empty where the run did not come to its end
  std::int64_t fast = 0;
  double dt_hat = 0;  ///< relative_step(), lib/scene/auto_step.h
  double nearest = 0;
  Double3 center{};  ///< of mass at the end, in h from the domain's lower corner
  double seconds = 0;
};

struct StabilityOptions {
  bool reduced = false;
  Backend backend = Backend::cpu;
  Precision precision = Precision::single;
  int threads = 0;                     ///< of one case; 0: all
  std::vector<std::string> overrides;  ///< --set, after the case's own
  std::string base_folder;             ///< as in load_scene()
  std::function<bool()> stop;          ///< asked between updates: whether to give up; empty: never
};

/// Without output, and where and with what the options say.
void without_files(Scene& scene, const StabilityOptions& o);

/// Runs one case and judges it, but for `like`. Throws Error(unavailable) where the backend is not
/// there; every other error of the case is judged. Empty when o.stop() said so.
std::optional<StabilityRow> run_stability_case(const StabilityCase& c, const StabilityOptions& o);

/// How far two centres of mass may lie apart to be alike, h.
constexpr double kLikeness = 0.05;

/// Judges `like` of every row, as the case of its name asks, against the row that is meant.
void judge_likeness(const std::vector<StabilityCase>& cases, std::vector<StabilityRow>& rows);

/// What a run went through, of what the criteria ask for.
struct Course : Figures {
  Diagnostics first, last;
  double scale = 0;        ///< J, energy_scale() at the start
  double released = 0;     ///< released_energy(), share of scale
  double penetration = 0;  ///< m, deepest in a wall or an obstacle at any measure
  double through = 0;      ///< kg, largest total of a flow gauge at any measure
  double impulse[3]{};     ///< N s, of all loads since the start
  std::optional<GuardEvent> event;
  std::string guard_text;
  std::optional<StepHistory> steps;  ///< with time.adaptive; its `updates` up to the end
};

/// Runs a scene under its guard to the end or to an alarm; `done` gets the solver at the end.
/// Empty when stop(), asked between updates, said so.
std::optional<Course> run_course(Start start, const std::function<bool()>& stop = {},
                                 const std::function<void(Solver&)>& done = {});

/// Least distance of two particles, in the unit of `x` (3 per particle); infinite for one particle.
double nearest_distance(const std::vector<double>& x);

}  // namespace pbf::inline campaign_module
