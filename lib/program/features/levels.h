// Levels: between lambda and delta, computes the multipliers of a hierarchy of grids from the
// densities of lambda. Delta moves the particles along their gradient.
#pragma once

#include <algorithm>

#include "kernels/pass_level_loads.h"
#include "lib/program/as_types.h"
#include "lib/program/features/solids.h"
#include "lib/program/levels.h"
#include "lib/program/pass.h"

namespace pbf::program_module {
inline std::int64_t per_cell(const Sizes& n) { return n.plan.levels.cells(); }
inline std::int64_t per_run(const Sizes& n) { return n.plan.levels.runs(n.scene.dimensions); }
inline std::int64_t per_brick(const Sizes& n) { return n.plan.levels.bricks(); }
inline std::int64_t per_node(const Sizes& n) { return n.plan.levels.nodes(); }
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// Per particle: its cell when the lists were made.
inline constexpr struct LevelHome : Plain<int> {
} level_home{{"level home", per_particle, Life::lists, false, Shown{"level cell"}}};
/// Per run: its first particle.
inline constexpr struct RunStart : Plain<int> {
} run_start{{"level run start", per_run, Life::lists}};
/// Per cell: number of particles; sum (of particles while lists are made, of C in iterations); the
/// factors of LevelFactorPass, 1/h.
inline constexpr struct CellCount : Plain<int> {
} cell_count{{"level cell count", per_cell, Life::lists}};
inline constexpr struct CellSum : Plain<std::int64_t> {
} cell_sum{{"level cell sum", per_cell, Life::pass}};
inline constexpr struct CellFactor : Vectors {
} cell_factor{{"level factor", per_cell, Life::lists}};
/// Per brick: the shares of its 8 corners in the sums of its cells.
inline constexpr struct CornerSum : Plain<std::int64_t, 8> {
} corner_sum{{"level corner sum", per_brick, Life::pass}};
/// Per node: WallBits of the walls below its hat; the same including those of coarser nodes around;
/// the factor from the sum of C to the multiplier; the multiplier (h^2).
inline constexpr struct NodeWalls : Plain<int> {
} node_walls{{"level walls", per_node, Life::lists}};
inline constexpr struct NodeReach : Plain<int> {
} node_reach{{"level reach", per_node, Life::lists}};
inline constexpr struct NodeAnswer : Numbers {
} node_answer{{"level answer", per_node, Life::lists}};
inline constexpr struct Multiplier : Numbers {
} multiplier{{"level multiplier", per_node, Life::pass}};
/// Per cell, h. The grain is the effect of one kExcessUnit in the sum around a node.
inline constexpr struct LevelMoves : Vectors {
} level_move{
    {"level move", per_cell, Life::pass, false,
     Shown{.quantity = "level displacement", .unit = "h", .row = &level_home, .grain = 4e-12}}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

inline bool has_open_faces(const Scene& s) { return !s.domain.open.empty(); }

using LevelMoveNeeds = Needs<Reads<field::level_home>, Looks<field::level_move>>;
/// Calls f with the LevelMove of the scene, or with NoLevelMove.
template <class G, class F>
void with_level_move(const G& c, F&& f) {
  using Real = typename G::Real;
  if (c.plan.levels.all.count == 0) return f(NoLevelMove<Real>{});
  f(LevelMove<Real>{c[field::level_home], c[field::level_move]});
}

/// The sums per cell and per corner of a brick, in the form that kernels use.
inline LevelSums level_sums(const LevelPlan& l, std::int64_t* cell_sum, std::int64_t* corner_sum) {
  LevelSums sums{l.all, {{}, true, cell_sum}, {{}, false, corner_sum}};
  for (int k = 0; k < 3; ++k) {
    sums.cells.grid.nodes[k] = l.grid.cells[k];
    sums.corners.grid.nodes[k] = 2 * l.grid.bricks(k);
  }
  return sums;
}

/// Assigns particles to cells and computes the factors of nodes and cells. The results are valid as
/// long as the lists.
struct LevelCellsAndNodes {
  static constexpr PassText text{"level cells", "levels"};
  using Needs =
      pbf::Needs<If<has_open_faces, Reads<field::position>>, Looks<field::bin_start>, SolidNeeds,
                 Places<field::level_home>, Places<field::run_start>, Totals<field::cell_count>,
                 Totals<field::cell_sum>, Places<field::cell_factor>, Totals<field::corner_sum>,
                 Places<field::node_walls>, Places<field::node_reach>, Places<field::node_answer>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    const LevelPlan& l = c.plan.levels;
    int* walls = c[field::node_walls];
    int* reach = c[field::node_reach];
    int* count = c[field::cell_count];
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.bricks(LevelHomePass<Real, decltype(d)::value>{
          {l.grid, c[field::corner_sum]},
          c.p,
          c[field::bin_start],
          has_open_faces(c.scene) ? c[field::position].rows() : nullptr,
          has_obstacles(c.scene) ? c[field::solid_scene] : nullptr,
          c[field::run_start],
          c[field::level_home],
          count,
          c[field::cell_sum]});
    });
    const LevelSums sums = level_sums(l, c[field::cell_sum], c[field::corner_sum]);
    c.teams(LevelNodePass<Real>{sums, c.p.boundary.walls, l.beta * l.grid.edge * l.grid.edge,
                                c[field::node_answer], walls});
    const LevelReachPass reached{l.all, walls, reach};
    c.shared(reached.items(), reached);
    const auto over = [&](int k) { return l.gamma / l.grid.last[k]; };
    c.items(l.grid.size(), LevelFactorPass<Real>{l.all,
                                                 l.grid,
                                                 l.gamma / l.grid.edge,
                                                 {over(0), over(1), over(2)},
                                                 count,
                                                 walls,
                                                 reach,
                                                 c[field::cell_factor]});
  }
};

struct LevelMultipliers {
  static constexpr PassText text{"level multipliers", "levels"};
  using Needs =
      pbf::Needs<Reads<field::density>, Looks<field::run_start>,
                 If<has_open_faces, Reads<field::level_home>>, Looks<field::node_answer>,
                 Looks<field::cell_factor>, Totals<field::cell_sum>, Totals<field::corner_sum>,
                 Places<field::multiplier>, Places<field::level_move>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    const LevelPlan& l = c.plan.levels;
    Real* multiplier = c[field::multiplier];
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.bricks(LevelSumPass<Real, decltype(d)::value>{
          {l.grid, c[field::corner_sum]},
          c[field::run_start],
          has_open_faces(c.scene) ? c[field::level_home].rows() : nullptr,
          c[field::density].rows(),
          c[field::cell_sum]});
    });
    const LevelSums sums = level_sums(l, c[field::cell_sum], c[field::corner_sum]);
    c.teams(LevelMultiplierPass<Real>{sums, c[field::node_answer], multiplier});
    c.items(l.grid.size(), LevelMovePass<Real>{l.all, l.grid, multiplier, c[field::cell_factor],
                                               c[field::level_move]});
  }
};

/// Runs after the multipliers if the scene has loads on walls.
struct BookLevels {
  static constexpr PassText text{"loads of the levels", "measure"};
  using Needs = pbf::Needs<Looks<field::multiplier>, Looks<field::cell_factor>,
                           Looks<field::cell_count>, BookNeeds>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    if (!(c.p.dt > 0)) return;
    const LevelPlan& l = c.plan.levels;
    c.items(l.all.level[0].size(),
            LevelLoadPass<Real>{l.all, l.grid, c[field::multiplier], c[field::cell_factor],
                                c[field::cell_count], c.p.boundary.extent,
                                load_book(c.scene, c.p.boundary, c[field::load_sums].sums(),
                                          nullptr, c[field::patches])});
  }
};

struct Levels {
  using Passes = PassList<LevelCellsAndNodes, LevelMultipliers, BookLevels>;
  static void add(const Scene& s, auto& b) {
    if (const char* why = why_no_levels(s)) return b.left_out("levels: grids coarser than h", why);
    b.lists(LevelCellsAndNodes(), true);
    b.iteration(LevelMultipliers());
    if (has_wall_loads(s)) b.iteration(BookLevels());
  }
};

}  // namespace pbf::PBF_VARIANT
