// What the emitters of a scene emit, as a function of time: no state is needed to resume or to go
// back. kernels/README.md, "Emitters and sinks".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "kernels/emission.h"
#include "lib/program/axes.h"
#include "lib/program/feature.h"
#include "lib/scene/nozzle.h"

namespace pbf::program_module {

struct Plan;

inline bool has_emitters(const Scene& s) { return !s.emitters.empty(); }
inline bool has_sinks(const Scene& s) { return !s.sinks.empty(); }
inline bool comes_and_goes(const Scene& s) { return has_emitters(s) || has_sinks(s); }

/// Speed and way of an emitter: linear between rows, 0 outside.
class SpeedCurve {
 public:
  SpeedCurve() = default;
  SpeedCurve(const Scene& scene, const Emitter& emitter);
  double speed(double t) const;      ///< m/s
  double way(double t) const;        ///< m, that layers have made by then
  double time_of(double way) const;  ///< s, the first time at which they have; infinite: never

 private:
  std::vector<double> time_, speed_, way_;
};

/// An emitter. Layers are numbered from 0 on; all have `columns` particles.
struct PlannedNozzle {
  NozzlePlace place;
  SpeedCurve curve;
  std::int64_t columns = 0;
  double area = 0;  ///< m^2, of the columns
};

struct EmissionPlan {
  double spacing = 0;         ///< m, of the layers
  double slack = 0;           ///< s: a layer that is due so much later has begun
  int layers = 0;             ///< that always wait in a pipe
  std::int64_t first_id = 0;  ///< particles of bodies
  int most_born = 0;          ///< layers of an emitter in a step
  std::vector<PlannedNozzle> nozzles;

  /// s, when a layer begins to wait; minus infinite for those of the start.
  double birth(std::size_t emitter, std::int64_t layer) const;
  /// How many layers have begun, and how many have left the pipe, at time t.
  std::int64_t born(std::size_t emitter, double t) const;
  std::int64_t released(std::size_t emitter, double t) const { return born(emitter, t) - layers; }
  /// Particles that have begun by t, those of the start included.
  std::int64_t particles(double t) const;
  std::int64_t at_start() const;
  /// The id of the first particle of a layer. Ids are given in the order of birth, then of
  /// emitters.
  std::int64_t id(std::size_t emitter, std::int64_t layer) const;
  /// The emitter and the layer of an id.
  std::pair<std::size_t, std::int64_t> of_id(std::int64_t id) const;
};

/// bodies: particles of bodies.
EmissionPlan plan_emission(const Scene& scene, std::int64_t bodies);
/// Particles that wait in the pipes at the start, after those of bodies.
std::int64_t particles_in_pipes(const Scene& scene);
/// Calls put(position, velocity) for each of them (m, m/s), in the order of ids.
template <class Put>
void for_each_in_pipes(const Scene& s, const Put& put) {
  for (const Emitter& e : s.emitters) {
    const NozzlePlace p = nozzle_place(s, e);
    const Double3 v = SpeedCurve(s, e).speed(0) * p.normal;
    for (const Double3& x : p.held(s.fluid.spacing, held_layers(s))) put(x, v);
  }
}

/// The casing of each emitter, as a solid. Lengths in h from Scene::origin(), along the scene's
/// axes.
std::vector<Solid<double>> casings_of(const Scene& scene);
/// The casings of all emitters, then their bores, along the internal axes.
std::vector<Solid<double>> casings_and_bores(const Scene& scene, const Axes& axes);

/// Rows of the table of steps of a solver: at least those of one update.
inline constexpr int kEmissionRows = 64;
std::int64_t emission_rows(const Plan& plan);

/// An emitter in a step: NozzleStep in double, lengths in m.
struct EmitterStep {
  double front = 0, speed = 0;
  int released = 0, held = 0, born = 0;
  std::int64_t id[kPipeLayers] = {};
};
/// substep: counted from the start of the run, of length dt. lists: per update, which has
/// `substeps`.
EmitterStep emitter_step(const EmissionPlan& plan, std::size_t emitter, std::int64_t substep,
                         double dt, int substeps, int lists);
/// The same at a time, in a step without time.
EmitterStep emitter_at(const EmissionPlan& plan, std::size_t emitter, double time);

/// Most particles at any time of the run, if no sink takes any.
std::int64_t most_particles_of(const Scene& scene, const EmissionPlan& plan);

/// kg m/s, per unit of EmissionSum::momentum.
double emission_momentum_unit(const Scene& scene, const Plan& plan);
/// The numbers of the columns of emitters and sinks (lib/program/column.h). time: s since the
/// start.
std::vector<double> emission_readings(const std::vector<EmissionSum>& sums, const Scene& scene,
                                      const Plan& plan, double time);
/// J, what all of them have brought less what they have taken.
double inflow_energy(const std::vector<EmissionSum>& sums, const Scene& scene, const Plan& plan);

/// "at t = 0.5 s emitters[0] (jet) had no room for a layer of 37 particles; ", for an id without a
/// row.
std::string no_row_text(const Scene& scene, const EmissionPlan& plan, std::int64_t id);
/// Lines about emitters for `pbf plan`; empty without any.
std::string emission_text(const Scene& scene, const Plan& plan);

}  // namespace pbf::program_module
