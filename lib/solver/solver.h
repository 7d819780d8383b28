// The interface between the program and a backend: called once per step, never per particle.
#pragma once

#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lib/base/stage_clock.h"
#include "lib/program/column.h"
#include "lib/scene/particles.h"
#include "lib/scene/scene.h"
#include "lib/solver/diagnostics.h"
#include "lib/solver/snapshot.h"
#include "lib/solver/stage_event.h"
#include "lib/solver/step_trace.h"

namespace pbf::program_module {
struct Plan;
}

namespace pbf::solver_module {

/// Properties of a solver and its machine, as stored in the run file.
struct SolverInfo {
  std::string backend;    ///< cpu, cuda
  std::string precision;  ///< float, double
  std::string device;     ///< CPU model or GPU name
  std::string driver;     ///< GPU driver; on the CPU the vector instructions (lib/program/simd.h)
  int threads = 0;
  double vol = 0;         ///< m/(rho0 h^3) with the calibrated mass: the weight of one particle
  double wall_scale = 0;  ///< factor on the walls' density, from the calibration
  std::size_t bytes = 0;  ///< of the present arrays (device memory on cuda)
  double launches = 0;    ///< cuda: kernels and fills of one step; 0 before one was recorded
  int recordings = 0;     ///< cuda: of updates, so far
  /// cuda, several ranks: the share of exchanges that ran beside other stages. The times of stages
  /// are shares of an update in which none does.
  double hidden_exchange = 0;
  std::vector<StageTime> stages{};  ///< since the solver was created
};

/// Options for the updates of one call.
struct StepOptions {
  int level = 0;  ///< an update is 2^level steps (lib/run/step_control.h)
  /// m/s: particles faster than this are counted in Diagnostics::fast. Ignored if the scene has a
  /// solver.speed_limit: then particles above that limit are counted.
  double watched_speed = std::numeric_limits<double>::infinity();
  /// Steps without time instead of updates. Such a step makes new lists and does the iterations
  /// with a one-sided constraint, which only separate particles. Velocities are multiplied by this
  /// factor and do not change otherwise. No update is counted; `level` is ignored.
  std::optional<double> without_time{};
  bool operator==(const StepOptions&) const = default;
};

/// The state to return: the present one, only its positions, or the copy that keep() made.
enum class StateOf { present, positions, kept };

/// Whether the interval over which readings are averaged continues or ends with this reading.
enum class Interval { goes_on, ends };

class Inspection;
class SplitRows;

/// One simulation. Two solvers may live in one process. Errors are thrown as Error.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Advances by `updates` times time.step.
  virtual void step(int updates, const StepOptions& options = {}) = 0;
  /// Copies position, id and the given fields (velocity, density) to the host: in the order of ids,
  /// in SI units, floating-point fields as `type`. Updates may run during the copy: get() waits
  /// only for the copy. At most one download at a time.
  virtual std::future<Snapshot> download(const std::vector<std::string>& fields,
                                         ScalarType type) = 0;
  virtual Diagnostics diagnose() = 0;
  /// The numbers of the columns of a series (lib/program/column.h). Means and peaks are those since
  /// the start or the last call for this series with Interval::ends.
  virtual std::vector<double> readings(Series series, Interval interval) = 0;
  /// After set_state(), this or another solver of the same scene and precision continues with the
  /// same bits. A solver of float rounds the state of a solver of double. Throws Error(internal) if
  /// check_state() does, or for StateOf::kept without keep().
  virtual SolverState state(StateOf which = StateOf::present) = 0;
  virtual void set_state(const SolverState& state) = 0;
  /// Keeps a copy of the state in the memory of the solver and replaces the previous copy. Cheap
  /// enough for every measurement.
  virtual void keep() = 0;
  virtual SolverInfo info() const = 0;
  virtual std::int64_t updates() const = 0;  ///< done so far
  /// Access for verification; null if the solver has none.
  virtual Inspection* inspection() { return nullptr; }
  /// Access to rows that are on several ranks (lib/solver/split_rows.h); null if all are here.
  virtual SplitRows* split() { return nullptr; }
};

/// Examines the results of every pass of an update. About ten times slower than step(1), with the
/// same bits.
class Inspection {
 public:
  virtual ~Inspection() = default;
  /// One update with the results of each pass, on the host. The bits are those of step(1) unless
  /// `options` change them.
  virtual StepTrace trace(const TraceOptions& options = {}) = 0;
  /// One update like step(1, options). Returns the first stage that exceeded the limits.
  virtual std::optional<StageEvent> step_checked(const StageLimits& limits,
                                                 const StepOptions& options = {}) = 0;
  /// For tests: later updates, including repeated ones, inject this fault at its update and stage.
  virtual void inject(const Fault& fault) = 0;
};

/// Throws Error(internal) for a state that does not fit a solver of n particles, or of at most n if
/// their number changes.
void check_state(const SolverState& state, std::int64_t n, bool changes = false);

}  // namespace pbf::solver_module
