// Levels: between lambda and delta, from the densities of lambda, the multipliers of a hierarchy of
// grids. Delta moves the particles by their gradient.
#pragma once

#include "kernels/pass_levels.h"
#include "lib/program/as_types.h"
#include "lib/program/levels.h"
#include "lib/program/pass.h"

namespace pbf::inline program_module::field {
/// LevelSum of each row of a cell (four, in two dimensions two) and of each node; h^2, the
/// multipliers of the nodes.
inline constexpr FieldInfo level_row{"level row", Type::int64, 8, Rows::cells};
inline constexpr FieldInfo level_node{"level node", Type::int64, 2, Rows::nodes};
inline constexpr FieldInfo multiplier{"multiplier", Type::real, 1, Rows::nodes};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// f(LevelMove or NoLevelMove) of the scene.
template <class C, class F>
void with_level_move(C& c, F&& f) {
  using Real = typename C::Real;
  const LevelPlan& l = c.levels;
  if (l.all.count == 0) return f(NoLevelMove<Real>{});
  const auto inverse = [&](int k) { return Real(1 / l.grid.last[k]); };
  f(LevelMove<Real>{l.grid,
                    l.all.level[0],
                    {inverse(0), inverse(1), inverse(2)},
                    Real(1 / l.grid.edge),
                    Real(l.gamma),
                    c.template data<Real>(field::multiplier)});
}

/// Levels of up to so many nodes are made together, by one block of a device: its launches take
/// longer than the work.
inline constexpr int kLevelsTogether = 4096;

template <class C>
LevelChainPass<typename C::Real> level_chain(C& c) {
  const LevelPlan& l = c.levels;
  int first = 1;
  while (first < l.all.count && l.all.level[first].size() > kLevelsTogether) ++first;
  return {l.all, first, typename C::Real(l.beta * l.grid.edge * l.grid.edge),
          c.template data<LevelSum>(field::level_node),
          c.template data<typename C::Real>(field::multiplier)};
}

struct LevelSums {
  static PassInfo info() {
    return {"level sums",
            "levels",
            {{&field::density}, {&field::bin_start}},
            {hidden({&field::level_row}), hidden({&field::level_node})}};
  }
  template <class C>
  static void launch(C& c) {
    const LevelPlan& l = c.levels;
    const auto chain = level_chain(c);
    auto* row = c.template data<LevelSum>(field::level_row);
    const bool open = !c.scene.domain.open.empty();
    with_dimensions(c.p.dimensions, [&](auto d) {
      constexpr int D = decltype(d)::value;
      c.over(l.grid.size() * kRowsPerCell<D>,
             LevelCellPass<typename C::Real, D>{c.p, l.grid, c.template data<int>(field::bin_start),
                                                open ? c.position() : nullptr, c.density(), row});
      c.over(l.all.level[0].size(),
             LevelNodePass<D>{c.p.boundary.walls, l.grid, l.all.level[0], row, chain.node});
    });
    for (int k = 1; k < chain.first; ++k)
      c.over(l.all.level[k].size(), LevelDownPass{l.all.level[k - 1], l.all.level[k], chain.node});
  }
};

struct LevelMultipliers {
  static PassInfo info() {
    return {"level multipliers", "levels", {{&field::level_node}}, {hidden({&field::multiplier})}};
  }
  template <class C>
  static void launch(C& c) {
    const auto chain = level_chain(c);
    if (chain.steps() > 0) c.exec.in_turn(chain);
    for (int k = chain.first; k-- > 0;) c.over(c.levels.all.level[k].size(), chain.up(k));
  }
};

struct Levels {
  using Passes = PassList<LevelSums, LevelMultipliers>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (const char* why = why_no_levels(s)) return b.left_out("levels: grids coarser than h", why);
    b.template iteration<LevelSums>();
    b.template iteration<LevelMultipliers>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
