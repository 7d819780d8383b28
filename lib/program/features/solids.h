// Obstacles, and walls with loads: their boundary, and a second launch of the passes over neighbors
// for the few particles near them.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/boundary/far_boundary.h"
#include "kernels/boundary/near_split.h"
#include "lib/program/features/dissipation.h"
#include "lib/program/features/loads.h"
#include "lib/program/obstacle_motion.h"
#include "lib/program/solid_maps.h"
#include "lib/program/time_order.h"

namespace pbf::program_module {
/// More than a box that stands still.
inline bool has_more_than_walls(const Scene& s) { return has_solids(s) || has_motion(s); }
/// Where solids are near is known beforehand, cell by cell.
inline bool has_solids_in_grid(const Scene& s) {
  return has_solids(s) && s.domain.is_closed() && !has_free_bodies(s);
}
/// Enough for all half cells of the grid.
inline std::int64_t per_half_cell(const Sizes& n) {
  return n.bins / bins_per_cell(n.scene.dimensions);
}
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// See kernels/boundary/near_rows.h.
inline constexpr struct NearRoom : Numbers {
} near_way_left{{"way left", per_padded_row, Life::lists}};
inline constexpr struct NearRow : Plain<int> {
} near_row{{"near rows", per_particle, Life::lists}};
inline constexpr struct NearCount : Plain<int> {
} near_count{{"near count", one_row, Life::lists}};
/// The half cells in which particles can be near solids, in the order of bins.
inline constexpr struct HalfCells : Plain<int> {
} near_half_cells{{"near half cells", per_half_cell, Life::run}};
inline constexpr struct SolidSceneRow : Objects {
} solid_scene{{kBytesOf<SolidScene>, "solid scene", one_row, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

template <class Real>
SolidScene<Real> row_of(const field::SolidSceneRow&);

/// The needs of a pass that asks solids for their density or their distance.
using SolidNeeds = Needs<If<has_obstacles, Looks<field::solid_scene>, Looks<field::solids>>,
                         If<has_maps, Looks<field::solid_maps>>>;
/// The needs of a pass over neighbors that leaves near rows to a second launch. The sums of these
/// rows are stored in the second array of velocities.
using NearNeeds = Needs<If<has_obstacles, Reads<field::near_way_left>, Looks<field::near_row>,
                           Looks<field::near_count>>,
                        SolidNeeds>;
using NearSumNeeds = If<has_obstacles, Places<other<field::velocity>>>;
/// The needs of a pass after which rows may have become near.
using ComeNearNeeds =
    Needs<If<has_solids, Updates<field::near_way_left>, Places<field::near_row>,
             Places<field::near_count>, Looks<field::solid_scene>>,
          If<has_obstacles, Looks<field::solids>>, If<has_maps, Looks<field::solid_maps>>>;
/// The needs of a pass that moves particles: loads are booked, too.
using MoveNeeds = Needs<ComeNearNeeds, BookNeeds>;
/// The needs of a pass in which particles begin a step. Those of a moving tank need the frame, too.
using StepNeeds = Needs<ComeNearNeeds, StartBookNeeds, ShareNeeds,
                        If<has_moving_obstacles, Looks<field::solids_before>>, Adds<field::counts>,
                        If<is_damped, Adds<field::dissipation>>>;
using FrameNeeds = If<has_tank_motion, Looks<field::frame>>;

struct NearSolids;

/// The boundary for one launch. It is not stored because flips and steps without time change it.
template <class G>
SolidBoundary<typename G::Real> solids_of(const G& c) {
  using Real = typename G::Real;
  SolidBoundary<Real> solids = c.template memory<NearSolids>().solids;
  static_cast<Box<Real>&>(solids) = c.p.boundary;
  solids.solid_scene = c.declared(field::solid_scene);
  solids.booked = has_loads(c.scene) && c.p.dt > 0;
  solids.frame = c.p.dt > 0 ? c.declared(field::frame) : nullptr;
  NearRows<Real>& near = solids.near;
  near.way_left_squared = c.declared(field::near_way_left);
  near.row = c.declared(field::near_row);
  near.count = c.declared(field::near_count);
  near.sums = c.declared(other<field::velocity>);
  // A far row is farther from all solids than the range of the walls' density.
  const auto way = c.p.dt * c.p.boundary.inv_range;
  near.per_speed = way * way * near.far_way_squared;
  return solids;
}

/// Calls f with the boundary of the scene: its box, or a box with obstacles or loads. Steps without
/// time book no loads.
template <class G, class F>
void with_boundary(const G& c, F&& f) {
  c.template memory<NearSolids>().more_than_walls ? f(solids_of(c)) : f(c.p.boundary);
}

/// The same for passes that leave particles near solids to a second launch.
template <class G, class F>
void with_far_boundary(const G& c, F&& f) {
  c.template memory<NearSolids>().more_than_walls ? f(FarBoundary<typename G::Real>(solids_of(c)))
                                                  : f(c.p.boundary);
}

/// Launches make(boundary), a pass over neighbors: once for all particles, and in scenes with
/// solids a second time for the particles near them. moves: the pass moves particles, so near walls
/// with loads need the second launch too.
template <bool moves, class G, class Make>
void each_then_near(const G& c, Make&& make) {
  const auto& memory = c.template memory<NearSolids>().solids;
  if (!memory.obstacles && !(moves && memory.loaded)) return c.pairs(make(c.p.boundary));
  const auto solids = solids_of(c);
  const auto far = make(FarBoundary<typename G::Real>(solids));
  const auto near = make(solids);
  c.pairs(FarHalf<std::decay_t<decltype(far)>>{far});
  c.listed(solids.near.count, NearHalf<std::decay_t<decltype(near)>>{near});
}

struct FindNear {
  static constexpr PassText text{"near solids", "neighbors"};
  using Needs =
      pbf::Needs<Reads<field::position>, Places<field::near_way_left>, Looks<field::near_row>,
                 Places<field::near_row>, Looks<field::near_count>, Places<field::near_count>,
                 SolidNeeds,
                 If<has_solids_in_grid, Looks<field::near_half_cells>, Looks<field::bin_start>>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    const SolidBoundary<Real> solids = solids_of(c);
    c.listed(solids.near.count, ForgetNearPass<Real>{solids.near});
    c.items(1, ClearNearPass<Real>{solids.near});
    if (const int cells = c.template memory<NearSolids>().half_cells; cells > 0)
      c.items(cells,
              FindNearPass<Real>{solids, c[field::position].rows(), c[field::near_half_cells],
                                 c[field::bin_start], bins_per_cell(c.p.dimensions)});
    else
      c.items(FindNearPass<Real>{solids, c[field::position].rows()});
  }
};

struct NearSolids {
  using Passes = PassList<FindNear>;
  static void add(const Scene& s, auto& b) {
    if (has_solids(s)) b.lists(FindNear());
  }

  template <class Real>
  struct Memory : NoMemory {
    bool more_than_walls = false;  ///< more than a box that stands still
    SolidBoundary<Real> solids{};  ///< without addresses
    MapAddresses<Real> maps{};
    int half_cells = 0;  ///< 0: particles anywhere may be near

    template <class C>
    void make(C& c) {
      const Scene& s = c.scene;
      more_than_walls = has_more_than_walls(s);
      if (!has_solids(s)) return;
      SolidScene<Real> scene;
      scene.walls = c.p.boundary;
      scene.solid = c.data(field::solids);
      scene.before = c.data(field::solids_before);
      scene.casings = int(s.emitters.size());
      scene.solids = int(s.obstacles.size()) + scene.casings;
      scene.flat = c.p.dimensions == 2;
      scene.loads = load_book(s, c.p.boundary, c.data(field::load_sums), c.data(field::clamp_sums),
                              c.data(field::patches));
      scene.share = c.data(field::body_shares);
      scene.sharers = c.data(field::sharers);
      c.put(field::solid_scene, {scene});
      if (has_maps(s)) {
        c.put(field::solid_maps, map_array<Real>(c.plan.solids));
        maps = MapAddresses<Real>(c.plan.solids, c.data(field::solid_maps));
      }
      const RunBounds<Real> run = bounds_of_run(s, c.plan, c.p.boundary);
      solids.obstacles = has_obstacles(s);
      solids.loaded = has_wall_loads(s);
      solids.bounds = run.all;
      solids.clear = clear_of(c.p.boundary);
      // The way that a row may make in an iteration of its lists.
      const int moves = std::max(s.solver.iterations, 1) * (1 + c.plan.shape().repeats);
      const double room = kNearRoom - (is_second_order(s) ? kPushPlaceAway : 0);
      const double move = 0.8 * room / moves;
      solids.near.far_way_squared = Real(move * move);
      c.exec.to_device(std::vector<Real>(C::padding, solids.near.far_way_squared).data(),
                       C::padding, c.data(field::near_way_left) + c.capacity());
      if (!has_solids_in_grid(s)) return;
      const std::vector<int> cells =
          half_cells_near_solids(s, run.standing, run.moving, c.p, solids.clear, solids.loaded);
      half_cells = int(cells.size());
      if (half_cells > 0) c.put(field::near_half_cells, cells);
    }
    /// All rows count as near until lists are made.
    void forget(auto& c) {
      if (!has_solids(c.scene)) return;
      const int n = c.host_rows();
      c.template as_pass<FindNear>([&](const auto& pass) {
        pass.items(std::max(n, 1),
                   AllNearPass<Real>{solids_of(pass).near, n});  // item 0 sets their number
      });
    }
  };
};

}  // namespace pbf::PBF_VARIANT
