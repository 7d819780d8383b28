// Free bodies in the memory of a solver.
#pragma once

#include "kernels/boundary/body_contact.h"
#include "lib/program/body_kinds.h"
#include "lib/program/features/loads.h"

namespace pbf::program_module {
inline std::int64_t per_body(const Sizes& n) { return free_bodies(n.scene); }
inline std::int64_t per_contact_spot(const Sizes& n) { return contact_spots_in(n.scene); }
}  // namespace pbf::program_module

namespace pbf::program_module::field {
inline constexpr struct BodyKinds : Plain<BodyKind> {
} body_kinds{{"body kinds", per_body, Life::run}};
inline constexpr struct BodyStates : Plain<BodyState> {
} body_states{{"body states", per_body, Life::state}};
/// Of it, BodyStep::seen counts until the end of the update, where it becomes 0.
inline constexpr struct BodySteps : Plain<BodyStep> {
} body_steps{{"body steps", per_body, Life::run}};
/// The points of all obstacles that may touch others, and which of them belong to each.
inline constexpr struct ContactSpots : Plain<ContactSpot> {
} contact_spots{{"contact points", per_contact_spot, Life::run}};
inline constexpr struct SolidSpotRows : Plain<SolidSpots> {
} solid_spots{{"contact points of solids", per_obstacle, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

/// How the free bodies move now; empty if there are none.
template <class C>
std::vector<BodyMotion> read_bodies(C& c) {
  std::vector<BodyMotion> out;
  if (!has_free_bodies(c.scene)) return out;
  std::vector<BodyState> now(std::size_t(free_bodies(c.scene)));
  c.exec.to_host(c.data(field::body_states), now.size(), now.data());
  const std::vector<BodyKind> kinds = body_kinds(c.scene, c.plan);
  for (std::size_t b = 0; b < now.size(); ++b)
    out.push_back(motion_of(kinds[b], now[b], c.scene, c.plan.axes));
  return out;
}

}  // namespace pbf::PBF_VARIANT
