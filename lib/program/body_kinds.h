// Free bodies in the form that kernels use (kernels/boundary/free_body.h).
#pragma once

#include <vector>

#include "kernels/boundary/body_contact.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

/// One for each free body, in the order of obstacles.
std::vector<BodyKind> body_kinds(const Scene& scene, const Plan& plan);
/// Their states at the start.
std::vector<BodyState> first_bodies(const Scene& scene, const Plan& plan,
                                    const std::vector<BodyKind>& kinds);
/// Where a body is and how it moves, in SI units along the axes of the scene.
BodyMotion motion_of(const BodyKind& kind, const BodyState& state, const Scene& scene,
                     const Axes& axes);

/// The points of solids that may touch others; of_solid: of obstacles, then of `more` solids
/// without any.
struct Spots {
  std::vector<ContactSpot> all;
  std::vector<SolidSpots> of_solid;
};
Spots contact_spots(const Scene& scene, const Plan& plan, std::size_t more);
/// Number of those points.
std::int64_t contact_spots_in(const Scene& scene);

}  // namespace pbf::program_module
