// Levels: between lambda and delta, computes the multipliers of a hierarchy of grids from the
// densities of lambda. Delta moves the particles along their gradient.
#pragma once

#include <algorithm>

#include "kernels/pass_level_loads.h"
#include "lib/program/as_types.h"
#include "lib/program/features/loads.h"
#include "lib/program/levels.h"
#include "lib/program/pass.h"

namespace pbf::inline program_module::field {
/// Of each particle the cell that it was in when the lists were made.
inline constexpr FieldInfo level_home{"level home", Type::int32, 1, Rows::particles};
/// Of each run, its first particle.
inline constexpr FieldInfo run_start{"level run start", Type::int32, 1, Rows::runs};
/// Of each cell: particles; sums, of particles while the lists are made, of C in iterations; what
/// LevelFactorPass names, 1/h.
inline constexpr FieldInfo cell_count{"level cell count", Type::int32, 1, Rows::cells};
inline constexpr FieldInfo cell_sum{"level cell sum", Type::int64, 1, Rows::cells};
inline constexpr FieldInfo cell_factor{"level factor", Type::real, 4, Rows::cells};
/// Of each brick's corners: shares of the sums.
inline constexpr FieldInfo corner_sum{"level corner sum", Type::int64, 8, Rows::bricks};
/// Of each node: WallBits of the walls under its hat; those and what coarser ones around it know;
/// what it makes of the sum of C, the multiplier (h^2).
inline constexpr FieldInfo node_walls{"level walls", Type::int32, 1, Rows::nodes};
inline constexpr FieldInfo node_reach{"level reach", Type::int32, 1, Rows::nodes};
inline constexpr FieldInfo node_answer{"level answer", Type::real, 1, Rows::nodes};
inline constexpr FieldInfo multiplier{"level multiplier", Type::real, 1, Rows::nodes};
/// Of each cell, h.
inline constexpr FieldInfo level_move{"level move", Type::real, 4, Rows::cells};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// f(LevelMove or NoLevelMove) of the scene.
template <class C, class F>
void with_level_move(C& c, F&& f) {
  using Real = typename C::Real;
  if (c.levels.all.count == 0) return f(NoLevelMove<Real>{});
  f(LevelMove<Real>{c.template data<int>(field::level_home), c.vectors(field::level_move)});
}

/// Over cells and bricks, and what lies at their corners.
template <class C>
LevelSums level_sums(C& c) {
  LevelSums sums{c.levels.all,
                 {{}, true, c.template data<std::int64_t>(field::cell_sum)},
                 {{}, false, c.template data<std::int64_t>(field::corner_sum)}};
  for (int k = 0; k < 3; ++k) {
    sums.cells.grid.nodes[k] = c.levels.grid.cells[k];
    sums.corners.grid.nodes[k] = 2 * c.levels.grid.bricks(k);
  }
  return sums;
}
template <class C>
const int* homes_beside_open_faces(C& c) {
  return c.scene.domain.open.empty() ? nullptr : c.template data<int>(field::level_home);
}

/// Who is in which cell, and what each node makes of its sum: as long as the lists.
struct LevelCellsAndNodes {
  static PassInfo info() {
    return {"level cells",
            "levels",
            {{&field::position}, {&field::bin_start}},
            {{{&field::level_home}, Written::scalar, "level cell"},
             hidden({&field::run_start}),
             hidden({&field::cell_count}),
             hidden({&field::cell_sum}),
             hidden({&field::cell_factor}),
             hidden({&field::corner_sum}),
             hidden({&field::node_walls}),
             hidden({&field::node_reach}),
             hidden({&field::node_answer})}};
  }
  template <class C>
  static void launch(C& c) {
    using Real = typename C::Real;
    const LevelPlan& l = c.levels;
    int* walls = c.template data<int>(field::node_walls);
    int* reach = c.template data<int>(field::node_reach);
    int* count = c.template data<int>(field::cell_count);
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.bricks(LevelHomePass<Real, decltype(d)::value>{
          {l.grid, c.template data<std::int64_t>(field::corner_sum)},
          c.p,
          c.template data<int>(field::bin_start),
          c.scene.domain.open.empty() ? nullptr : c.position(),
          c.scene.obstacles.empty() ? nullptr : c.solids().around,
          c.template data<int>(field::run_start),
          c.template data<int>(field::level_home),
          count,
          c.template data<std::int64_t>(field::cell_sum)});
    });
    const LevelSums sums = level_sums(c);
    c.teams(LevelNodePass<Real>{sums, c.p.boundary.walls, l.beta * l.grid.edge * l.grid.edge,
                                c.template data<Real>(field::node_answer), walls});
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
                                                 c.vectors(field::cell_factor)});
  }
};

struct LevelMultipliers {
  static PassInfo info() {
    return {"level multipliers",
            "levels",
            {{&field::density},
             {&field::run_start},
             {&field::level_home},
             {&field::node_answer},
             {&field::cell_factor}},
            {hidden({&field::cell_sum}), hidden({&field::corner_sum}), hidden({&field::multiplier}),
             move()}};
  }
  static Written move() {
    Written w = vector({&field::level_move}, "level displacement", "h");
    w.row = &field::level_home;
    w.grain = 4e-12;  // kExcessUnit of one particle among those around a node
    return w;
  }
  template <class C>
  static void launch(C& c) {
    using Real = typename C::Real;
    const LevelPlan& l = c.levels;
    auto* multiplier = c.template data<Real>(field::multiplier);
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.bricks(LevelSumPass<Real, decltype(d)::value>{
          {l.grid, c.template data<std::int64_t>(field::corner_sum)},
          c.template data<int>(field::run_start),
          homes_beside_open_faces(c),
          c.density(),
          c.template data<std::int64_t>(field::cell_sum)});
    });
    const LevelSums sums = level_sums(c);
    c.teams(LevelMultiplierPass<Real>{sums, c.template data<Real>(field::node_answer), multiplier});
    c.items(l.grid.size(),
            LevelMovePass<Real>{l.all, l.grid, multiplier, c.vectors(field::cell_factor),
                                c.vectors(field::level_move)});
  }
};

/// Behind the multipliers, where loads are asked for.
struct BookLevels {
  static PassInfo info() {
    return {"loads of the levels",
            "measure",
            {{&field::multiplier}, {&field::cell_factor}, {&field::cell_count}},
            {hidden({&field::load_sums})}};
  }
  template <class C>
  static void launch(C& c) {
    using Real = typename C::Real;
    if (!(c.p.dt > 0)) return;
    const LevelPlan& l = c.levels;
    c.items(
        l.all.level[0].size(),
        LevelLoadPass<Real>{l.all, l.grid, c.template data<Real>(field::multiplier),
                            c.vectors(field::cell_factor), c.template data<int>(field::cell_count),
                            c.p.boundary.extent, load_book(c)});
  }
};

struct Levels {
  using Passes = PassList<LevelCellsAndNodes, LevelMultipliers, BookLevels>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (const char* why = why_no_levels(s)) return b.left_out("levels: grids coarser than h", why);
    b.template lists<LevelCellsAndNodes>();
    b.template iteration<LevelMultipliers>();
    if (has_wall_loads(s)) b.template iteration<BookLevels>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
