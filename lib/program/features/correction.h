// The position correction of one iteration, including the artificial pressure and the displacement
// by the levels.
#pragma once

#include <type_traits>

#include "kernels/pass_delta.h"
#include "lib/program/features/levels.h"
#include "lib/program/features/motion.h"

namespace pbf::PBF_VARIANT {

/// density: of the pass that leaves 1/density; null with moves_on.
template <Smoothing S, TensilePower tensile, class G, class Lists, class Coarse, class Order,
          class Boundary>
auto delta_pass(const G& c, const Lists& lists, OwnRows<const typename G::Real> density,
                StepCounts* moves_on, const Coarse& coarse, const Order& order,
                const Boundary& boundary, Vec4<typename G::Real>* motion = nullptr) {
  auto p = c.p;
  p.sor = c.sor();
  return DeltaPass<typename G::Real, Lists, S, tensile, Coarse, Order, Boundary>{
      p,        boundary,     lists,         c[other<field::position>],
      density,  c[field::id], moved_rows(c), c[field::velocity],
      moves_on, coarse,       order,         motion};
}
inline bool has_tensile(const Scene& s) { return s.tensile && s.tensile->k != 0; }
/// Lists: of the passes.
template <class Lists, class F>
void with_tensile(const Scene& s, F&& f) {
  if (!has_tensile(s)) return f(std::integral_constant<TensilePower, TensilePower::none>{});
  if constexpr (!Lists::cheap_branches)
    if (s.tensile->n == 4) return f(std::integral_constant<TensilePower, TensilePower::fourth>{});
  f(std::integral_constant<TensilePower, TensilePower::any>{});
}

/// The same for passes in turns (lib/program/turns.h).
template <class F>
void with_turn_tensile(const Scene& s, F&& f) {
  has_tensile(s) ? f(std::integral_constant<TensilePower, TensilePower::fourth>{})
                 : f(std::integral_constant<TensilePower, TensilePower::none>{});
}

/// free: with moves_on in second order. motion: DeltaPass::motion.
template <class G>
void launch_delta(const G& c, OwnRows<const typename G::Real> density, Vec4<typename G::Real>* free,
                  StepCounts* moves_on, Vec4<typename G::Real>* motion = nullptr) {
  c.with_smoothing([&](auto s) {
    constexpr Smoothing S = decltype(s)::value;
    with_tensile<typename G::Lists>(c.scene, [&](auto tensile) {
      with_level_move(c, [&](const auto& coarse) {
        const DissipationBook damping = moves_on ? damping_book(c) : DissipationBook{};
        with_order<S, typename G::Real>(c.scene, free, damping, [&](const auto& order) {
          each_then_near<true>(c, [&](const auto& boundary) {
            // The pass for near rows sums over no pairs but coincident ones, so it has one form:
            // nvcc takes 5 s for each.
            constexpr bool near =
                std::is_same_v<std::decay_t<decltype(boundary)>, SolidBoundary<typename G::Real>>;
            constexpr TensilePower form = near ? TensilePower::any : decltype(tensile)::value;
            return delta_pass<S, form>(c, c.lists(), density, moves_on, coarse, order, boundary,
                                       motion);
          });
        });
      });
    });
  });
}

/// Moving obstacles push from where the step has taken a particle in their own frame.
inline bool pushes_in_moving_frames(const Scene& s) {
  return is_second_order(s) && has_moving_obstacles(s);
}

using DeltaNeeds = Needs<Gathers<other<field::position>, W::lambda>, UsesLists, Gathers<field::id>,
                         Updates<field::velocity>, If<has_levels, LevelMoveNeeds>, MoveNeeds,
                         If<has_solids, Looks<field::near_row>, Looks<field::near_count>,
                            Places<other<field::velocity>>>,
                         If<pushes_in_moving_frames, Looks<field::solids_before>>>;

struct Delta {
  static constexpr PassText text{"delta", "delta"};
  using Needs = pbf::Needs<Writes<field::position, W::inverse_density>, Reads<field::density>,
                           DeltaNeeds, PacksPositions, ShareNeeds>;
  static void launch(const auto& c) { launch_delta(c, c[field::density], nullptr, nullptr); }
};

/// Delta and the prediction of the next substep: the same arithmetic with one launch less. Not
/// where a pass runs between the two, as with carried loads and free bodies.
struct DeltaPredict {
  using Fuses = Pair<Delta, Predict>;
  static constexpr PassText text{"delta+predict", "delta"};
  using Needs = Then<pbf::Needs<Writes<field::position>, DeltaNeeds, PacksPositions>,
                     pbf::Needs<Updates<field::position, W::mark>, Updates<field::velocity>,
                                If<is_second_order, Updates<field::free_velocity>>, MoveNeeds,
                                If<has_moving_obstacles, Looks<field::solids_before>>,
                                Adds<field::counts>, If<is_damped, Adds<field::dissipation>>>>;
  template <class G>
  static void launch(const G& c) {
    launch_delta(c, OwnRows<const typename G::Real>(), c.declared(field::free_velocity),
                 c[field::counts].sums());
  }
};

struct Correction {
  using Passes = PassList<Delta, DeltaPredict>;
  static void add(const Scene& s, auto& b) {
    if (s.solver.iterations == 0) return;
    b.iteration(Delta());
    if (!has_tensile(s)) b.left_out("artificial pressure in the delta loop", "no key tensile");
  }
};

}  // namespace pbf::PBF_VARIANT
