// The density constraint: density and lambda of one iteration.
#pragma once

#include "kernels/pass_lambda.h"
#include "kernels/pass_packed_lambda.h"
#include "kernels/pass_residual.h"
#include "lib/program/features/motion.h"

namespace pbf::PBF_VARIANT {

struct Density {
  static constexpr PassText text{"density", "density"};
  using Needs = pbf::Needs<Gathers<field::position>, UsesLists, Writes<field::density>, NearNeeds,
                           NearSumNeeds>;
  template <class G>
  static void launch(const G& c) {
    c.with_smoothing([&](auto s) {
      each_then_near<false>(c, [&](const auto& boundary) {
        return DensityPass<typename G::Real, typename G::Lists, decltype(s)::value,
                           std::decay_t<decltype(boundary)>>{c.p, boundary, c.lists(),
                                                             c[field::position], c[field::density]};
      });
    });
  }
};

/// Velocities of neighbors are needed for marked particles, which the first iteration counts before
/// it moves anything.
using LambdaNeeds =
    Needs<If<is_not_packed, Gathers<field::position>>,
          If<is_packed, Gathers<field::packed_position>, Reads<field::position>>, UsesLists,
          Reads<field::position, W::mark, When::first_iteration>,
          Gathers<field::velocity, W::any, When::first_iteration>,
          If<is_second_order, Reads<field::velocity>>, NearNeeds, NearSumNeeds, ShareNeeds,
          Writes<other<field::position>, W::lambda>, Adds<field::counts>>;

template <Smoothing S, bool with_density, class G, class Lists, class Order, class Boundary>
auto lambda_pass(const G& c, const Lists& lists, const Order&, const Boundary& boundary) {
  return LambdaPass<typename G::Real, Lists, S, with_density, Order, Boundary>{
      c.p,
      boundary,
      lists,
      c[field::position],
      c[other<field::position>],
      c[field::density],
      c[field::velocity],
      c[field::counts].sums()};
}
template <class Lists, Smoothing S, class Order, class Boundary>
auto of_packed(const LambdaPass<float, Lists, S, true, Order, Boundary>& pass,
               GatheredRows<PackedPosition> packed) {
  return PackedLambdaPass<Lists, S, Order, Boundary>{pass, packed};
}
template <bool with_density, class G>
void launch_lambda(const G& c) {
  c.with_smoothing([&](auto s) {
    constexpr Smoothing S = decltype(s)::value;
    with_order<S, typename G::Real>(c.scene, nullptr, {}, [&](const auto& order) {
      const auto launch = [&](const auto& form) {
        each_then_near<false>(c, [&](const auto& boundary) {
          return form(lambda_pass<S, with_density>(c, c.lists(), order, boundary));
        });
      };
      if constexpr (has_packed_rows<G> && with_density && S == Smoothing::consistent)
        if (c.plan.packed)
          return launch(
              [&](const auto& pass) { return of_packed(pass, c[field::packed_position]); });
      launch([](const auto& pass) { return pass; });
    });
  });
}

struct Lambda {
  static constexpr PassText text{"lambda", "lambda"};
  using Needs = pbf::Needs<Reads<field::density>, LambdaNeeds>;
  static void launch(const auto& c) { launch_lambda<false>(c); }
};

struct DensityLambda {
  static constexpr PassText text{"density+lambda", "lambda"};
  using Needs = pbf::Needs<Writes<field::density>, LambdaNeeds>;
  static void launch(const auto& c) { launch_lambda<true>(c); }
};

struct Constraint {
  using Passes = PassList<Density, Lambda, DensityLambda>;
  static void add(const Scene& s, auto& b) {
    if (s.solver.iterations == 0)
      return b.left_out("lambda and delta passes", "solver.iterations is 0");
    if (s.solver.fused) {
      b.iteration(DensityLambda());
      b.left_out("density pass of its own", "solver.fused is true");
    } else {
      b.iteration(Density());
      b.iteration(Lambda());
    }
  }
};

}  // namespace pbf::PBF_VARIANT
