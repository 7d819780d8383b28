// Which parts of an update take energy from the motion, and are booked for it.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/dissipation.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

struct Plan;

/// In the order of their columns.
enum class Dissipation { viscosity, friction, hyperviscosity, confinement, damping };
inline constexpr const char* kDissipationNames[] = {"viscosity", "friction", "hyperviscosity",
                                                    "confinement", "damping"};

/// Whether the scene has this one.
bool dissipates(const Scene& scene, Dissipation by);
inline bool is_damped(const Scene& s) { return dissipates(s, Dissipation::damping); }

/// Those that the scene has, in their order.
std::vector<Dissipation> dissipations(const Scene& scene);

/// J, the unit of the sums, for a particle.
double dissipation_unit(const Scene& scene, const Plan& plan);
/// J, what each of them has taken since the start. sums: the same number for each.
std::vector<double> dissipated(const std::vector<DissipationSum>& sums, const Scene& scene,
                               const Plan& plan);

}  // namespace pbf::program_module
