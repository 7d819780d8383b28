// The sums of the energy that passes take from the motion. Passes that do declare
// Adds<field::dissipation> and book with dissipation_book().
#pragma once

#include "lib/program/dissipation.h"
#include "lib/program/field.h"
#include "lib/program/needs.h"
#include "lib/program/plan.h"

namespace pbf::program_module {
inline std::int64_t per_dissipation_sum(const Sizes& n) {
  return dissipation_sums(n.particles) * std::int64_t(dissipations(n.scene).size());
}
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// dissipation_sums() for each of dissipations().
inline constexpr struct DissipationRows : Plain<DissipationSum, 1, std::int64_t> {
} dissipation{{"dissipation", per_dissipation_sum, Life::state}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

/// factor: on what add() gets. Books nothing in scenes without `by`.
template <Dissipation by, class G>
DissipationBook dissipation_book(const G& c, double factor = 1) {
  if (!dissipates(c.scene, by)) return {};
  const int sums = dissipation_sums(c.capacity());
  int place = 0;
  for (const Dissipation other : dissipations(c.scene)) place += other < by;
  return {c.declared(field::dissipation) + place * sums, sums - 1,
          factor / c.plan.dissipation_unit};
}
/// The same for a viscosity: predictions take over a share of the change of velocity, and a share
/// of that share, which take energy, too.
template <Dissipation by, class G>
DissipationBook viscous_book(const G& c) {
  return dissipation_book<by>(c, 1 / (1 - double(c.p.carry)));
}
/// For a step, in which velocities are damped: add() gets v^2.
template <class G>
DissipationBook damping_book(const G& c) {
  const double damping = double(c.p.damping);
  return dissipation_book<Dissipation::damping>(c, 0.5 * (1 - damping * damping));
}

}  // namespace pbf::PBF_VARIANT
