// Lists, lambda and delta of all iterations, and XSPH behind them, in one launch, where the
// executor has that and the plan says so. Lambda and delta alone then also are a part of that
// kernel: the compiler may fuse products and sums in one kernel that it does not fuse in another.
// XSPH is written so that it has the same bits in any kernel.
#pragma once

#include <span>
#include <type_traits>

#include "kernels/pass_sort.h"
#include "lib/program/features.h"
#include "lib/solver/granted.h"
#include "lib/solver/other_rows.h"

namespace pbf::PBF_VARIANT {

/// Calls f(lambda, delta, xsph) with the passes of the executor's kernel. xsph: of the right type,
/// without arrays.
template <class C, class Lists, class F>
void with_turns(C& c, const Lists& lists, F&& f) {
  constexpr Smoothing S = Smoothing::consistent;
  using Real = typename C::Real;
  const auto passes = [&](const auto& of_lambda, const auto& of_delta) {
    with_turn_tensile(c.scene, [&](auto tensile) {
      with_order<S, Real>(c.scene, nullptr, {}, [&](const auto& order) {
        f(lambda_pass<S, true>(of_lambda, lists, order, c.p.boundary),
          delta_pass<S, decltype(tensile)::value>(of_delta, lists, of_delta[field::density],
                                                  nullptr, NoLevelMove<Real>{}, order,
                                                  c.p.boundary),
          XsphPass<Real, Lists, S, std::decay_t<decltype(order)>, Box<Real>>{});
      });
    });
  };
  c.template as_pass<DensityLambda>([&](const auto& of_lambda) {
    c.template as_pass<Delta>([&](const auto& of_delta) { passes(of_lambda, of_delta); });
  });
}

template <class C>
constexpr bool has_turns = sizeof(typename C::Real) == 4 && requires {
  typename std::remove_reference_t<decltype(std::declval<C>().exec)>::TurnLists;
};

/// Whether P ran as a part of that kernel.
template <class P, class C>
bool take_turn(C& c) {
  constexpr bool lambda = std::is_same_v<P, DensityLambda>;
  if constexpr (has_turns<C> && (lambda || std::is_same_v<P, Delta>)) {
    if (!c.plan.turns) return false;
    using Exec = std::remove_reference_t<decltype(c.exec)>;
    with_turns(c, typename Exec::TurnLists{c.lists},
               [&](const auto&... passes) { c.exec.turn(c.rows(), lambda, passes...); });
    return true;
  } else {
    return false;
  }
}

template <class P, class C>
bool is_pass(const Steps& steps, std::size_t k) {
  return k < steps.size() && steps[k].kind == ProgramStep::pass &&
         steps[k].index == C::Passes::template index_of<P>();
}

/// A pass that `launch` runs together with others, and then counts the bins that it finds.
template <class Pass, class Launch>
struct LaunchedTogether : Pass {
  Launch launch;
};
/// Runs P, which is XSPH or begins with it: launch(xsph, arrivals) runs XSPH together with other
/// passes. xsph: of the type of XSPH in that launch.
template <class P, class C, class Pass>
void run_xsph(C& c, const auto& lists, const Pass&, const auto& launch) {
  swap_arrays<P>(c);
  const auto use = [&](const auto& pass, const auto&... sort) {
    if constexpr (std::is_same_v<std::decay_t<decltype(pass)>, Pass>) {
      const auto at_once = [&](const Arrivals<false>& arrivals) { launch(pass, arrivals); };
      if constexpr (sizeof...(sort) > 0)
        (sort(LaunchedTogether<Pass, std::decay_t<decltype(at_once)>>{pass, at_once}), ...);
      else
        at_once({});
    }
  };
  c.template as_pass<P>([&](const auto& granted) { P::with(granted, lists, use); });
}

/// Runs steps[k] and what may follow in one launch, where the executor can; k is then the last step
/// that ran with it. Otherwise nothing has run.
template <class C>
bool take_turns(C& c, const Steps& steps, std::size_t& k) {
  if constexpr (has_turns<C>) {
    if (!c.plan.turns) return false;
    if (has_other_ranks(c)) return false;  // they exchange rows between passes
    const bool makes_lists = is_pass<MakeLists, C>(steps, k);
    const std::size_t at = makes_lists ? k + 1 : k;
    if (at == steps.size() || steps[at].kind != ProgramStep::iterate) return false;
    const ProgramStep& round = steps[at];
    using Exec = std::remove_reference_t<decltype(c.exec)>;
    const typename Exec::TurnLists lists{makes_lists ? c.exec.prepare_lists(c.capacity())
                                                     : c.lists};
    const int* bin_start = makes_lists ? c.data(field::bin_start) : nullptr;
    const auto factors =
        std::span(c.factors).subspan(std::size_t(round.first), std::size_t(round.times));
    bool taken = false;
    with_turns(c, lists, [&](const auto& lambda, const auto& delta, const auto& no_xsph) {
      taken = c.exec.has_turns(c.rows(), lambda, delta, no_xsph);
      if (!taken) return;
      if (makes_lists) c.take_lists(lists);
      c.iterations += round.times;
      k = at;
      const auto launch = [&](const auto& xsph, const Arrivals<false>& arrivals) {
        c.exec.turns(c.rows(), bin_start, factors, lambda, delta, xsph, arrivals);
      };
      const bool walls_alone = !c.template memory<NearSolids>().more_than_walls;
      const auto with = [&]<class P>(P) {
        const bool next = walls_alone && is_pass<P, C>(steps, at + 1);
        if (next) run_xsph<P>(c, lists, no_xsph, launch), ++k;
        return next;
      };
      if (!with(Xsph()) && !with(XsphPredictSort())) launch(no_xsph, {});
    });
    return taken;
  } else {
    return false;
  }
}

}  // namespace pbf::PBF_VARIANT
