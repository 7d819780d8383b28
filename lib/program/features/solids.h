// Obstacles, and walls with loads: their boundary, and a second launch of the passes over neighbors
// for the few particles near them.
#pragma once

#include "kernels/boundary/far_box.h"
#include "kernels/boundary/near_split.h"
#include "lib/program/features/loads.h"

namespace pbf::inline program_module::field {
/// See kernels/boundary/near_rows.h.
inline constexpr struct NearRoom : Numbers {
} near_room{{"room", per_padded_row, Life::lists}};
inline constexpr struct NearRow : Plain<int> {
} near_row{{"near rows", per_particle, Life::lists}};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

inline bool has_obstacles(const Scene& s) { return !s.obstacles.empty(); }
/// The needs of a pass over neighbors that leaves near rows to a second launch. The sums of these
/// rows are stored in the second array of velocities.
using NearNeeds = If<has_obstacles, Reads<field::near_room>, Looks<field::near_row>>;
using NearSumNeeds = If<has_obstacles, Places<other<field::velocity>>>;
/// The needs of a pass that moves particles: rows may become near, and loads are booked.
using MoveNeeds =
    Needs<If<has_solids, Updates<field::near_room>, Places<field::near_row>>, BookNeeds>;

/// The boundary for one launch. It is not stored because flips and steps without time change it.
template <class C>
Solids<typename C::Real> solids_of(C& c) {
  Solids<typename C::Real> solids = c.solids();
  static_cast<Box<typename C::Real>&>(solids) = c.p.boundary;
  solids.loaded = has_wall_loads(c.scene);
  solids.booked = has_loads(c.scene) && c.p.dt > 0;
  solids.near.sums = c.template data<Vec4<typename C::Real>>(other<field::velocity>);
  if (!(c.p.dt > 0)) solids.frame = nullptr;
  // A far row is farther from all solids than the range of the walls' density.
  const auto way = c.p.dt * c.p.boundary.inv_range;
  solids.near.per_speed = way * way * solids.near.far_way_squared;
  return solids;
}

/// Calls f with the boundary of the scene: its box, or a box with obstacles or loads. Steps without
/// time book no loads.
template <class C, class F>
void with_boundary(C& c, F&& f) {
  c.solids().around ? f(solids_of(c)) : f(c.p.boundary);
}

/// The same for passes that leave particles near solids to a second launch.
template <class C, class F>
void with_far_boundary(C& c, F&& f) {
  using Real = typename C::Real;
  c.solids().around ? f(FarBox<Real>(solids_of(c))) : f(c.p.boundary);
}

/// Launches make(boundary), a pass over neighbors: once for all particles, and in scenes with
/// solids a second time for the particles near them. moves: the pass moves particles, so near walls
/// with loads need the second launch too.
template <bool moves, class G, class Make>
void each_then_near(const G& c, Make&& make) {
  using Real = typename G::Real;
  auto& parts = c.context();
  if (!parts.solids().around) return c.pairs(make(c.p.boundary));
  const Solids<Real> solids = solids_of(parts);
  if (!solids.obstacles && !(moves && solids.loaded)) return c.pairs(make(c.p.boundary));
  const auto far = make(FarBox<Real>(solids));
  const auto near = make(solids);
  c.pairs(FarHalf<std::decay_t<decltype(far)>>{far});
  c.listed(solids.near.count, NearHalf<std::decay_t<decltype(near)>>{near});
}

struct FindNear {
  static constexpr PassText text{"near solids", "neighbors"};
  using Needs =
      pbf::Needs<Reads<field::position>, Looks<field::bin_start>, Places<field::near_room>,
                 Looks<field::near_row>, Places<field::near_row>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    auto& parts = c.context();
    const Solids<Real> solids = solids_of(parts);
    c.listed(solids.near.count, ForgetNearPass<Real>{solids.near});
    c.items(1, ClearNearPass<Real>{solids.near});
    if (const auto& cells = parts.near_half_cells(); cells.size() > 0)
      c.items(int(cells.size()),
              FindNearPass<Real>{solids, c[field::position].rows(), cells.data(),
                                 c[field::bin_start], bins_per_cell(c.p.dimensions)});
    else
      c.items(FindNearPass<Real>{solids, c[field::position].rows()});
  }
};

struct NearSolids {
  using Passes = PassList<FindNear>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (has_solids(s)) b.template lists<FindNear>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
