// The interface between the program and a backend: called per step, never per particle.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/scene/particles.h"
#include "lib/scene/scene.h"
#include "lib/solver/measures.h"
#include "lib/solver/snapshot.h"
#include "lib/solver/stage_event.h"
#include "lib/solver/step_trace.h"

namespace pbf::inline program_module {
struct Plan;
}

namespace pbf::inline solver_module {

/// Seconds spent in one stage since the solver was made. `name` is the name of the pass.
struct StageTime {
  std::string name;
  double seconds = 0;
  std::int64_t calls = 0;
};

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
};

/// One simulation. Two solvers may live in one process. Errors are thrown as Error.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Advances by `updates` times time.step.
  virtual void step(int updates) = 0;
  /// From now on an update is 2^level steps (lib/run/step_control.h); 0 at first. The state and
  /// keep() know nothing of it.
  virtual void set_step_level(int level) = 0;
  /// Steps without time: new lists and sweeps, which part what is too near and draw nothing
  /// together (one-sided, whatever the scene's constraint), while velocities change by the factor
  /// `damping` per step alone. No update is counted.
  virtual void relax(int steps, double damping = 1) = 0;
  /// Where the particles are now: 3 coordinates each in units of h from Scene::origin(), in the
  /// order of ids, with all digits that they have.
  virtual std::vector<double> positions() = 0;
  /// Copies the fields asked for (velocity, density; position and id always) to the host, in id
  /// order, SI units, positions and floating-point fields as f32 or f64 as `type` says.
  virtual Snapshot download(const std::vector<std::string>& fields, ScalarType type) = 0;
  /// The same in two halves, so that updates may run while the copy is under way: at most one
  /// download at a time; finish_download() waits for the copy, not for later updates.
  virtual void start_download(const std::vector<std::string>& fields, ScalarType type) {
    started_ = download(fields, type);
  }
  virtual Snapshot finish_download() { return std::move(started_); }
  virtual Measures measure() = 0;
  /// The state as it is now. set_state() of it, in this or in another solver of the same scene and
  /// precision, continues to the last bit. Positions and velocities of a double are rounded where
  /// they go into a solver of float. Error(internal) when the number of
  /// particles differs or the ids are not 0..n-1 in some order.
  virtual SolverState state() = 0;
  virtual void set_state(const SolverState& state) = 0;
  /// One update, with what each pass left behind, on the host: some ten times slower than step(1),
  /// whose bits it gives unless `options` ask for others. Error(internal) at a level above 0.
  virtual StepTrace trace(const TraceOptions& options = {}) = 0;
  /// Keeps a copy of the state where the solver's arrays are, in place of the one before: cheap
  /// enough for every measure. kept() brings it to the host; Error(internal) when there is none.
  virtual void keep() = 0;
  virtual SolverState kept() = 0;
  /// Counts particles faster than `speed` (m/s) in Measures::fast from now on. Without effect where
  /// the scene has a solver.speed_limit: then those above it are counted.
  virtual void watch_speed(double speed) = 0;
  /// One update like step(1), looking at what each stage left behind: some ten times slower.
  virtual std::optional<StageEvent> step_checked(const StageLimits& limits) = 0;
  /// For tests: updates from now on put this fault in when its time comes, also repeated ones.
  virtual void inject(const Fault& fault) = 0;
  virtual std::vector<StageTime> timings() const = 0;
  virtual SolverInfo info() const = 0;
  virtual std::int64_t updates_done() const = 0;
  virtual double time() const = 0;  ///< s

 private:
  Snapshot started_;
};

/// Throws Error(internal) for a state that a solver of n particles cannot take over.
void check_state(const SolverState& state, std::int64_t n);

}  // namespace pbf::inline solver_module
