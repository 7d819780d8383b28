// The guard: decides from a measurement whether a run is still valid, and finds the update, stage
// and particle that caused a fault.
#pragma once

#include <optional>
#include <string>

#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::inline run_module {

/// Mean compression of a start that has come apart, 1.
inline constexpr double kApart = 0.01;

/// Kinetic and potential energy, less the work of what moves by itself, as the guard and the
/// stability suite count it, J.
double total_energy(const Diagnostics& m);
/// What growth is measured by, J: the kinetic energy relative to the centre of mass, which is the
/// same for every observer in uniform motion, and the potential energy above the face of the domain
/// towards which gravity pulls. mass: of one particle, kg.
double energy_scale(const Diagnostics& m, const Scene& scene, double mass, std::int64_t particles);

/// The latter part alone.
double energy_of_height(const Diagnostics& m, const Scene& scene, double mass,
                        std::int64_t particles);

/// What a start may give back when nothing has relieved it (lib/run/prestabilize.h), J:
/// (compression_mean - 1 %) M (h/dt)^2/2, for its particles leave each other by up to h in a step
/// of dt (of one substep). Without `one_sided`, a free surface is pulled in, by 0.02 to 0.05 h in
/// the first update, and by twice that before it comes to rest: as if the mean were 1 % more. dt is
/// that of level 0 (time.adaptive).
double released_energy(const Diagnostics& first, const Scene& scene, const Plan& plan);

/// Updates in which a start gives that back: a wave that passes h in an update crosses the domain
/// twice, and 20 more.
std::int64_t release_updates(const Scene& scene);

/// Half of what a coordinate may be off by rounding, h: that of the far end of the domain.
double position_rounding(const Scene& scene);

/// Limits of a run, SI units.
struct GuardLimits {
  double speed = 0;            ///< m/s
  double energy = 0;           ///< J, kinetic plus potential, of a start that releases nothing
  std::int64_t neighbors = 0;  ///< of one particle
};

/// Limits from the scene's guard block and the first measure of the run. Where a key is `auto`:
/// speed: 10 (fastest at the start + fall through the domain + what motions give + h/dt): no flow
/// from that start reaches it. energy: that of the start, + 0.1 energy_scale, + M (0.01 h/dt)^2/2,
/// with gravity at most 0.1 M g h, + 64 times what rounding of the positions gives. neighbors: 4
/// times the most at the start, at least 16 times the rest_neighbors() at rest. dt is
/// time.step/substeps whatever the level (time.adaptive): what stopped a run with the long step
/// does not pass for good with a shorter one.
GuardLimits guard_limits(const Scene& scene, const Plan& plan, const Diagnostics& first);

/// Why a run was stopped, SI units.
struct GuardEvent {
  Alarm alarm = Alarm::non_finite;
  Diagnostics measure;          ///< the measure that showed it
  double value = 0, limit = 0;  ///< of what the alarm is about
  /// The first stage at fault; absent where repeating the updates did not show it again.
  std::optional<StageEvent> stage;
  Double3 position{}, velocity{};  ///< of the particle in `stage`, m and m/s
  SolverState last_good;           ///< at the last measure without an alarm
};

class Guard {
 public:
  /// scene.guard must be there. Keeps the state.
  /// `first`: the measure that the run began with, `now`: that of the present state; `released`: of
  /// a checkpoint.
  Guard(const Scene& scene, const Plan& plan, Solver& solver, const Diagnostics& first,
        const Diagnostics& now, std::optional<double> released = {});

  /// What the updates are to be made with, at level 0.
  StepOptions options() const { return {.watched_speed = limits_.speed}; }
  /// What is wrong with a new measure, if anything.
  std::optional<Alarm> alarm(const Diagnostics& m) const;
  /// Keeps the state of a good one as the last good state.
  void keep(const Diagnostics& m);
  /// Finds what is wrong by repeating the updates since then stage by stage, with the `options`
  /// that they were made with. The solver has then gone back.
  GuardEvent locate(Alarm alarm, const Diagnostics& m, const StepOptions& options);
  const Diagnostics& last_good() const { return good_; }

  const GuardLimits& limits() const { return limits_; }
  /// J, of a measure. Where guard.energy is auto, the larger of the scales of the start and of the
  /// measure counts: a body that hits a wall has none before. While the start comes apart, for
  /// release_updates() at most, released_energy() is allowed on top; what it has released by then
  /// is no growth. A start that is still compressed then has nothing to release: it must have the
  /// energy that it began with.
  double energy_limit(const Diagnostics& m) const;
  /// J, the energy when the start had come apart; nothing before. A checkpoint holds it.
  std::optional<double> released() const { return released_; }
  /// One paragraph: update, stage, particle, position, value, limit, and the keys to change.
  std::string text(const GuardEvent& e) const;
  /// A scene that repeats the event from the last good state, which lies in particle file `path`;
  /// at the finest level of time.adaptive, with its steps as updates.
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

/// Positions and velocities of a state, SI units, in the order of ids: in a scene made of them row,
/// and so id, are what they were. What rounding has put beyond a face of the domain is put on it.
Particles to_particles(const SolverState& state, const Scene& scene);

}  // namespace pbf::inline run_module
