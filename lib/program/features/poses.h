// Obstacles in the memory of a solver: where they are, and what moves them in a step.
#pragma once

#include "kernels/boundary/solid_scene.h"
#include "lib/program/feature.h"
#include "lib/program/free_bodies.h"
#include "lib/program/motion.h"
#include "lib/program/pass.h"

namespace pbf::program_module {
/// With the casing and the bore of each emitter behind them (kernels/boundary/solid_scene.h).
inline std::int64_t solids_in(const Scene& s) {
  return std::int64_t(s.obstacles.size() + 2 * s.emitters.size());
}
inline std::int64_t per_obstacle(const Sizes& n) { return solids_in(n.scene); }
inline bool has_obstacles(const Scene& s) { return solids_in(s) > 0; }
inline bool has_tank_motion(const Scene& s) { return s.tank_motion.has_value(); }
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// At the end of the present step.
inline constexpr struct SolidRows : Objects {
} solids{{kBytesOf<PosedSolid>, "solids", per_obstacle, Life::run}};
/// The same at its start, and their velocities, if an obstacle moves.
inline constexpr struct SolidsBefore : Objects {
} solids_before{{kBytesOf<Solid>, "solids before", per_obstacle, Life::run}};
inline constexpr struct SolidVelocities : Plain<SolidVelocity> {
} solid_velocity{{"solid velocity", per_obstacle, Life::run}};
/// Of obstacles that are free bodies (kernels/README.md, "Free bodies"), and particles that may
/// push them: kLoadParts for each solid, 0 between two updates.
inline constexpr struct BodyShares : Plain<BodyShare> {
} body_shares{{"body shares", per_obstacle, Life::run}};
inline constexpr struct SharerRows : Plain<SharerSums, kLoadParts, std::int64_t> {
} sharers{{"sharers", per_obstacle, Life::update}};
/// The motion of the tank in the present step.
inline constexpr struct Frame : Objects {
} frame{{kBytesOf<FrameStep>, "frame", one_row, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

/// The needs of a pass in which free bodies give way.
using ShareNeeds = If<has_free_bodies, Looks<field::body_shares>, Adds<field::sharers>>;

template <class Real>
PosedSolid<Real> row_of(const field::SolidRows&);
template <class Real>
Solid<Real> row_of(const field::SolidsBefore&);
template <class Real>
FrameStep<Real> row_of(const field::Frame&);

}  // namespace pbf::PBF_VARIANT
