// Obstacles, and walls with loads: their own boundary, and a second launch of the passes over
// neighbours for the few particles near them.
#pragma once

#include "kernels/boundary/far_box.h"
#include "kernels/boundary/near_split.h"
#include "lib/program/features/loads.h"

namespace pbf::inline program_module::field {
/// See kernels/boundary/near_rows.h.
inline constexpr FieldInfo near_room{"room", Type::real, 1, Rows::padded};
inline constexpr FieldInfo near_row{"near rows", Type::int32, 1, Rows::particles};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// Of the present state: arrays are flipped, walls may be those of steps without time.
template <class C>
Solids<typename C::Real> solids_of(C& c) {
  Solids<typename C::Real> solids = c.solids();
  static_cast<Box<typename C::Real>&>(solids) = c.p.boundary;
  solids.loaded = has_wall_loads(c.scene);
  solids.booked = has_loads(c.scene) && c.p.dt > 0;
  solids.near.sums = c.other(field::velocity);
  if (!(c.p.dt > 0)) solids.frame = nullptr;
  // A far row is farther from what it can meet than the range of the walls' density.
  const auto way = c.p.dt * c.p.boundary.inv_range;
  solids.near.per_speed = way * way * solids.near.far_way_squared;
  return solids;
}

/// f(the boundary of the scene): its box, or a box with obstacles or loads. Steps without time move
/// nothing that a wall would feel.
template <class C, class F>
void with_boundary(C& c, F&& f) {
  c.solids().around ? f(solids_of(c)) : f(c.p.boundary);
}

/// The same for passes that leave what is near solids to another launch.
template <class C, class F>
void with_far_boundary(C& c, F&& f) {
  using Real = typename C::Real;
  c.solids().around ? f(FarBox<Real>(solids_of(c))) : f(c.p.boundary);
}

/// Launches make(boundary), a pass over neighbours: once for all particles, and where there is more
/// than plain walls once more for those near it. moves: the pass moves particles, so that loads are
/// booked in it.
template <bool moves, class C, class Make>
void each_then_near(C& c, Make&& make) {
  using Real = typename C::Real;
  if (!c.solids().around) return c.pairs(make(c.p.boundary));
  const Solids<Real> solids = solids_of(c);
  if (!solids.obstacles && !(moves && solids.loaded)) return c.pairs(make(c.p.boundary));
  const auto far = make(FarBox<Real>(solids));
  const auto near = make(solids);
  c.pairs(FarHalf<std::decay_t<decltype(far)>>{far});
  c.listed(solids.near.count, NearHalf<std::decay_t<decltype(near)>>{near});
}

struct FindNear {
  static PassInfo info() {
    return {"near solids",
            "neighbors",
            {{&field::position}},
            {hidden({&field::near_room}), hidden({&field::near_row})}};
  }
  template <class C>
  static void launch(C& c) {
    using Real = typename C::Real;
    const Solids<Real> solids = solids_of(c);
    c.listed(solids.near.count, ForgetNearPass<Real>{solids.near});
    c.items(1, ClearNearPass<Real>{solids.near});
    if (const auto& cells = c.near_half_cells(); cells.size() > 0)
      c.items(int(cells.size()), FindNearPass<Real>{solids, c.position(), cells.data(),
                                                    c.template data<int>(field::bin_start),
                                                    bins_per_cell(c.p.dimensions)});
    else
      c.items(FindNearPass<Real>{solids, c.position()});
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
