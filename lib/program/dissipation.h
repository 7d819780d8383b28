// Which parts of an update take energy from the motion, and are booked for it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/dissipation.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

struct Plan;

/// In the order of their columns.
enum class Dissipation { viscosity, friction, hyperviscosity, confinement, damping, sponge };
inline constexpr const char* kDissipationNames[] = {"viscosity",   "friction", "hyperviscosity",
                                                    "confinement", "damping",  "sponge"};

/// Whether the scene has this one.
bool dissipates(const Scene& scene, Dissipation by);
inline bool is_damped(const Scene& s) { return dissipates(s, Dissipation::damping); }

/// Those that the scene has, in their order.
std::vector<Dissipation> dissipations(const Scene& scene);

/// The number of units in sums together, which is exact up to its conversion.
double units_in(std::span<const DissipationSum> sums);
inline double units_in(const DissipationSum& sum) { return units_in(std::span(&sum, 1)); }
/// J, the unit of the sums, for a particle; also of EmissionSum::energy.
double dissipation_unit(const Scene& scene, const Plan& plan);
/// J, what each of them has taken since the start. sums: the same number for each.
std::vector<double> dissipated(const std::vector<DissipationSum>& sums, const Scene& scene,
                               const Plan& plan);

}  // namespace pbf::program_module
