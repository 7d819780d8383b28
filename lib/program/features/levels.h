// Levels: between lambda and delta, from the densities of lambda, the multipliers of a hierarchy of
// grids. Delta moves the particles by their gradient.
#pragma once

#include "kernels/pass_levels.h"
#include "lib/program/as_types.h"
#include "lib/program/levels.h"
#include "lib/program/pass.h"

namespace pbf::inline program_module::field {
/// LevelSum of each cell and node; h^2, the multipliers of the nodes.
inline constexpr FieldInfo level_cell{"level cell", Type::int64, 2, Rows::cells};
inline constexpr FieldInfo level_node{"level node", Type::int64, 2, Rows::nodes};
inline constexpr FieldInfo multiplier{"multiplier", Type::real, 1, Rows::nodes};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// f(LevelMove or NoLevelMove) of the scene.
template <class C, class F>
void with_level_move(C& c, F&& f) {
  using Real = typename C::Real;
  const LevelPlan& l = c.levels;
  if (l.levels.empty()) return f(NoLevelMove<Real>{});
  const auto inverse = [&](int k) { return Real(1 / l.grid.last[k]); };
  f(LevelMove<Real>{l.grid,
                    l.levels[0],
                    {inverse(0), inverse(1), inverse(2)},
                    Real(1 / l.grid.edge),
                    Real(l.gamma),
                    c.template data<Real>(field::multiplier)});
}

struct LevelSums {
  static PassInfo info() {
    return {"level sums",
            "levels",
            {{&field::density}, {&field::bin_start}},
            {hidden({&field::level_cell}), hidden({&field::level_node})}};
  }
  template <class C>
  static void launch(C& c) {
    const LevelPlan& l = c.levels;
    auto* cell = c.template data<LevelSum>(field::level_cell);
    auto* node = c.template data<LevelSum>(field::level_node);
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.over(l.grid.size(), LevelCellPass<typename C::Real, decltype(d)::value>{
                                c.p, l.grid, c.template data<int>(field::bin_start), c.position(),
                                c.density(), cell});
    });
    c.over(l.levels[0].size(),
           LevelNodePass<typename C::Real>{c.p.boundary.walls, l.grid, l.levels[0], cell, node});
    for (std::size_t k = 1; k < l.levels.size(); ++k)
      c.over(l.levels[k].size(), LevelDownPass{l.levels[k - 1], l.levels[k], node});
  }
};

struct LevelMultipliers {
  static PassInfo info() {
    return {"level multipliers", "levels", {{&field::level_node}}, {hidden({&field::multiplier})}};
  }
  template <class C>
  static void launch(C& c) {
    using Real = typename C::Real;
    const LevelPlan& l = c.levels;
    for (std::size_t k = l.levels.size(); k-- > 0;) {
      const bool coarsest = k + 1 == l.levels.size();
      const double edge = std::ldexp(l.grid.edge, int(k));
      c.over(l.levels[k].size(), LevelUpPass<Real>{l.levels[k], l.levels[coarsest ? k : k + 1],
                                                   coarsest, Real(l.beta * edge * edge),
                                                   c.template data<LevelSum>(field::level_node),
                                                   c.template data<Real>(field::multiplier)});
    }
  }
};

struct Levels {
  using Passes = PassList<LevelSums, LevelMultipliers>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (!has_levels(s)) return b.left_out("levels: grids coarser than h", "solver.levels is off");
    b.template iteration<LevelSums>();
    b.template iteration<LevelMultipliers>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
