// The guard: decides from a measurement whether a run is still valid, and finds the update, stage
// and particle that caused a fault.
#pragma once

#include <optional>
#include <string>

#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::run_module {

/// Mean compression (ratio) at or below which a compressed start counts as relaxed.
inline constexpr double kApart = 0.01;

/// Kinetic plus potential energy minus the work of prescribed motions, as the guard and the
/// stability suite use it, J.
double total_energy(const Diagnostics& m);
/// The scale for energy growth, J: the kinetic energy relative to the center of mass, which is the
/// same for all observers in uniform motion, plus the potential energy above the face of the domain
/// towards which gravity points.
double energy_scale(const Diagnostics& m, const Scene& scene, const Plan& plan);

/// Only the potential energy of energy_scale(), J; mass: of all particles, kg.
double energy_of_height(const Diagnostics& m, const Scene& scene, double mass);

/// Energy that a start which was not relieved (lib/run/prestabilize.h) may release, J:
/// (compression_mean - 1 %) M (h/dt)^2/2, because its particles move apart by up to h in a step of
/// dt (one substep, at level 0 of time.adaptive). Without `one_sided`, a free surface is also
/// pulled in, by 0.02 to 0.05 h in the first update and twice that before it comes to rest; this
/// counts as 1 % more compression.
double released_energy(const Diagnostics& first, const Scene& scene, const Plan& plan);

/// Number of updates in which a start releases this energy: a wave that travels h per update
/// crosses the domain twice, plus 20.
std::int64_t release_updates(const Scene& scene);

/// Largest rounding error of a coordinate at the far end of the domain, h.
double position_rounding(const Scene& scene);

/// Limits of a run, SI units.
struct GuardLimits {
  double speed = 0;            ///< m/s
  double energy = 0;           ///< J, kinetic plus potential, without released energy
  std::int64_t neighbors = 0;  ///< of one particle
};

/// Limits from the scene's guard block and the first measurement of the run. Where a key is `auto`,
/// speed: 10 (largest at the start + fall through the domain + bound from motions + h/dt), which no
/// flow from that start reaches; energy: that of the start + 0.1 energy_scale + M (0.01 h/dt)^2/2
/// (with gravity at most 0.1 M g h) + 64 times the effect of rounding the positions; neighbors: 4
/// times the maximum at the start, at least 16 rest_neighbors(). dt is time.step/substeps at every
/// level (time.adaptive), so that a fault found with a long step remains one with a shorter step.
GuardLimits guard_limits(const Scene& scene, const Plan& plan, const Diagnostics& first);

/// Why a run was stopped, SI units.
struct GuardEvent {
  Alarm alarm = Alarm::non_finite;
  Diagnostics measure;          ///< the measurement that raised the alarm
  double value = 0, limit = 0;  ///< of the quantity of the alarm
  /// The first stage at fault; absent if repeating the updates did not reproduce the fault.
  std::optional<StageEvent> stage;
  Double3 position{}, velocity{};  ///< of the particle in `stage`, m and m/s
  SolverState last_good;           ///< at the last measurement without an alarm
};

class Guard {
 public:
  /// The scene must have a guard block. Keeps the present state. `first`: first measurement of the
  /// run; `now`: that of the present state; `released`: as read from a checkpoint.
  Guard(const Scene& scene, const Plan& plan, Solver& solver, const Diagnostics& first,
        const Diagnostics& now, std::optional<double> released = {});

  /// Options for the updates, at level 0.
  StepOptions options() const { return {.watched_speed = limits_.speed}; }
  /// The alarm that a new measurement raises, if any.
  std::optional<Alarm> alarm(const Diagnostics& m) const;
  /// Keeps the present state, with measurement `m`, as the last good state.
  void keep(const Diagnostics& m);
  /// Finds the cause of an alarm by repeating the updates since the last good state stage by stage,
  /// with the `options` of these updates. The solver has then gone back.
  GuardEvent locate(Alarm alarm, const Diagnostics& m, const StepOptions& options);
  const Diagnostics& last_good() const { return good_; }

  const GuardLimits& limits() const { return limits_; }
  /// Energy limit at a measurement, J. If guard.energy is auto, the larger of the energy scales of
  /// the start and of the measurement counts, because a body that later hits a wall has no scale at
  /// the start. While a compressed start relaxes, for at most release_updates(), released_energy()
  /// is allowed in addition; energy released by then is not growth. A start that is still
  /// compressed after that gets no such allowance.
  double energy_limit(const Diagnostics& m) const;
  /// Energy when the start had relaxed, J; absent before. A checkpoint stores it.
  std::optional<double> released() const { return released_; }
  /// One paragraph: update, stage, particle, position, value, limit, and keys to change.
  std::string text(const GuardEvent& e) const;
  /// A scene that repeats the event from the last good state, stored in the particle file `path`,
  /// with the steps of the finest level of time.adaptive as updates.
  Scene repeating_scene(const GuardEvent& e, const std::string& path) const;

 private:
  bool came_apart(const Diagnostics& m) const;
  double event_limit(const Diagnostics& m) const;
  void follow_release(const Diagnostics& m);
  std::string remedy(const GuardEvent& e) const;

  const Scene scene_;
  const Plan plan_;
  Solver& solver_;
  GuardLimits limits_;
  Diagnostics first_, good_;
  std::optional<double> released_;
};

/// Positions and velocities of a state that a solver has returned, SI units, in the order of ids,
/// from which a run that starts with them makes the same prediction for its first step:
/// in a scene made of them row, and so id, are what they were, but for gaps. What rounding has put
/// beyond a face of the domain is put on it.
Particles to_particles(const SolverState& state, const Scene& scene);

}  // namespace pbf::run_module
