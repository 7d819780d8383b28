// Levels: between lambda and delta, from the densities of lambda, the multipliers of a hierarchy of
// grids. Delta moves the particles by their gradient.
#pragma once

#include <algorithm>

#include "kernels/pass_levels.h"
#include "lib/program/as_types.h"
#include "lib/program/levels.h"
#include "lib/program/pass.h"

namespace pbf::inline program_module::field {
/// Of each particle the cell that it was in when the lists were made.
inline constexpr FieldInfo level_home{"level home", Type::int32, 1, Rows::particles};
/// Of each cell: particles, and the sum of C.
inline constexpr FieldInfo cell_count{"level cell count", Type::int32, 1, Rows::cells};
inline constexpr FieldInfo cell_sum{"level cell sum", Type::int64, 1, Rows::cells};
/// Of each node: what LevelNodes names, the sum of C, the multiplier (h^2).
inline constexpr FieldInfo node_count{"level node count", Type::int64, 1, Rows::nodes};
inline constexpr FieldInfo node_sum{"level node sum", Type::int64, 1, Rows::nodes};
inline constexpr FieldInfo node_answer{"level answer", Type::real, 1, Rows::nodes};
inline constexpr FieldInfo multiplier{"level multiplier", Type::real, 1, Rows::nodes};
inline constexpr FieldInfo node_walls{"level walls", Type::int32, 1, Rows::nodes};
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

/// Levels of up to so many nodes are made together, by one block of a device: its launches take
/// longer than the work.
inline constexpr int kLevelsTogether = 64;

inline LevelSteps small_levels(const LevelPlan& l) {
  int first = 1;
  while (first < l.all.count && l.all.level[first].size() > kLevelsTogether) ++first;
  return {l.all, first};
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
             hidden({&field::cell_count}),
             hidden({&field::node_count}),
             hidden({&field::node_answer}),
             hidden({&field::node_walls})}};
  }
  template <class C>
  static void launch(C& c) {
    using Real = typename C::Real;
    const LevelPlan& l = c.levels;
    int* count = c.template data<int>(field::cell_count);
    const LevelNodeChain<Real> chain{
        small_levels(l),
        l.beta * l.grid.edge * l.grid.edge,
        {c.template data<LevelCount>(field::node_count), c.template data<Real>(field::node_answer),
         c.template data<int>(field::node_walls)}};
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.over(l.grid.size(), LevelHomePass<Real, decltype(d)::value>{
                                c.p, l.grid, c.template data<int>(field::bin_start),
                                c.scene.domain.open.empty() ? nullptr : c.position(),
                                c.template data<int>(field::level_home), count});
    });
    c.over(l.all.level[0].size(), LevelNodePass<Real>{c.p.boundary.walls, l.grid, l.all.level[0],
                                                      chain.stiffness, count, chain.node});
    for (int k = 1; k < chain.first; ++k) c.over(l.all.level[k].size(), chain.coarser(k));
    if (chain.steps() > 0) c.exec.in_turn(chain);
    for (int k = std::min(chain.first, l.all.count - 1); k-- > 0;)
      c.over(l.all.level[k].size(), chain.walls(k));
  }
};

struct LevelMultipliers {
  static PassInfo info() {
    return {"level multipliers",
            "levels",
            {{&field::density},
             {&field::bin_start},
             {&field::level_home},
             {&field::node_answer},
             {&field::node_walls},
             {&field::cell_count}},
            {hidden({&field::cell_sum}), hidden({&field::node_sum}), hidden({&field::multiplier}),
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
    auto* cell = c.template data<std::int64_t>(field::cell_sum);
    const LevelSumChain<Real> chain{small_levels(l), c.template data<Real>(field::node_answer),
                                    c.template data<std::int64_t>(field::node_sum),
                                    c.template data<Real>(field::multiplier)};
    with_dimensions(c.p.dimensions, [&](auto d) {
      constexpr int D = decltype(d)::value;
      c.over(l.grid.size(),
             LevelSumPass<Real, D>{c.p, l.grid, c.template data<int>(field::bin_start),
                                   homes_beside_open_faces(c), c.density(), cell});
      c.over(l.all.level[0].size(),
             LevelNodeSumPass<Real>{l.grid, l.all.level[0], chain.answer, cell, chain.sum});
      for (int k = 1; k < chain.first; ++k) c.over(l.all.level[k].size(), chain.coarser(k));
      if (chain.steps() > 0) c.exec.in_turn(chain);
      c.over(l.all.level[0].size(),
             LevelMultiplierPass<Real>{l.all, chain.answer, chain.sum, chain.multiplier});
      c.over(l.grid.size(),
             LevelMovePass<Real, D>{l.grid, l.all.level[0], Real(l.gamma), chain.multiplier,
                                    c.template data<int>(field::node_walls),
                                    c.template data<int>(field::cell_count),
                                    c.vectors(field::level_move)});
    });
  }
};

struct Levels {
  using Passes = PassList<LevelCellsAndNodes, LevelMultipliers>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (const char* why = why_no_levels(s)) return b.left_out("levels: grids coarser than h", why);
    b.template lists<LevelCellsAndNodes>();
    b.template iteration<LevelMultipliers>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
