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
#include "lib/scene/particles.h"
#include "lib/scene/scene.h"
#include "lib/solver/diagnostics.h"
#include "lib/solver/snapshot.h"
#include "lib/solver/stage_event.h"
#include "lib/solver/step_trace.h"
#include "lib/solver/wall_loads.h"

namespace pbf::inline program_module {
struct Plan;
}

namespace pbf::inline solver_module {

/// What ran where; goes into the run file.
struct SolverInfo {
  std::string backend;    ///< cpu, cuda
  std::string precision;  ///< float, double
  std::string device;     ///< CPU model or GPU name
  std::string driver;     ///< of the GPU; on the CPU the vector instructions (lib/exec/cpu/simd.h)
  int threads = 0;
  double vol = 0;         ///< m/(rho0 h^3) with the calibrated mass: the weight of one particle
  double wall_scale = 0;  ///< factor on the walls' density, from the calibration
  std::size_t bytes = 0;  ///< of the arrays held now (device memory on cuda)
  double launches = 0;    ///< cuda: kernels and fills of one step; 0 before one was recorded
  std::vector<StageTime> stages{};  ///< since it was made
};

/// How the updates of one call are made.
struct StepOptions {
  int level = 0;  ///< an update is 2^level steps (lib/run/step_control.h)
  /// m/s: particles faster than this are counted in Diagnostics::fast. Without effect where the
  /// scene has a solver.speed_limit: then those above it are counted.
  double watched_speed = std::numeric_limits<double>::infinity();
  /// Steps without time instead of updates: new lists and iterations, which part what is too near
  /// and draw nothing together (one-sided, whatever the scene's constraint), while velocities
  /// change by this factor per step alone. No update is counted, and the level does not matter.
  std::optional<double> without_time{};
  bool operator==(const StepOptions&) const = default;
};

/// Which state is asked for: the present one, its positions alone, or the copy that keep() made.
enum class Which { now, positions, kept };

/// Whether the interval of loads that is looked at goes on, or ends and a new one begins.
enum class Interval { goes_on, ends };

class Inspection;

/// One simulation. Two solvers may live in one process. Errors are thrown as Error.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Advances by `updates` times time.step.
  virtual void step(int updates, const StepOptions& options = {}) = 0;
  /// Copies the fields asked for (velocity, density; position and id always) to the host, in id
  /// order, SI units, positions and floating-point fields as f32 or f64 as `type` says. Updates may
  /// run while the copy is under way: get() waits for it, not for them. At most one at a time.
  virtual std::future<Snapshot> download(const std::vector<std::string>& fields,
                                         ScalarType type) = 0;
  virtual Diagnostics measure() = 0;
  /// Of the walls whose loads are summed, means since the start or since they were taken last.
  virtual std::vector<WallLoad> loads(Interval interval) = 0;
  /// What the gauges read: gauge_readings() (lib/solver/gauge_readings.h). Means since the start or
  /// since they were read last with Interval::ends.
  virtual std::vector<double> gauges(Interval interval) = 0;
  /// set_state() of the state, in this or in another solver of the same scene and precision,
  /// continues to the last bit. Positions and velocities of a double are rounded where they go into
  /// a solver of float. Error(internal) when the number of particles differs or the ids are not
  /// 0..n-1 in some order; and for the kept state where nothing was kept.
  virtual SolverState state(Which which = Which::now) = 0;
  virtual void set_state(const SolverState& state) = 0;
  /// Keeps a copy of the state where the solver's arrays are, in place of the one before: cheap
  /// enough for every measure.
  virtual void keep() = 0;
  virtual SolverInfo info() const = 0;
  virtual std::int64_t updates() const = 0;  ///< done so far
  /// What verification needs; null where a solver has none.
  virtual Inspection* inspection() { return nullptr; }
};

/// Looks at what every pass of an update leaves behind: some ten times slower than step(1), whose
/// bits it gives.
class Inspection {
 public:
  virtual ~Inspection() = default;
  /// One update, with what each pass left behind, on the host; other bits than those of step(1)
  /// where `options` ask for them.
  virtual StepTrace trace(const TraceOptions& options = {}) = 0;
  /// One update like step(1, options), looking for the first stage that went beyond the limits.
  virtual std::optional<StageEvent> step_checked(const StageLimits& limits,
                                                 const StepOptions& options = {}) = 0;
  /// For tests: updates from now on put this fault in when its time comes, also repeated ones.
  virtual void inject(const Fault& fault) = 0;
};

/// Throws Error(internal) for a state that a solver of n particles cannot take over.
void check_state(const SolverState& state, std::int64_t n);

}  // namespace pbf::inline solver_module
