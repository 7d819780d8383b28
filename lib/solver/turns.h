// Lists, lambda and delta of all iterations in one launch, where the executor has that and the plan
// says so. Each of the two passes alone then also is a part of that kernel: the compiler may fuse
// products and sums in one kernel that it does not fuse in another.
#pragma once

#include <span>
#include <type_traits>

#include "lib/program/features.h"
#include "lib/solver/granted.h"
#include "lib/solver/other_rows.h"

namespace pbf::PBF_VARIANT {

/// Calls f(lambda, delta) with the two passes of the executor's kernel.
template <class C, class F>
void with_turns(C& c, const auto& lists, F&& f) {
  constexpr Smoothing S = Smoothing::consistent;
  using Real = typename C::Real;
  const auto passes = [&](const auto& of_lambda, const auto& of_delta) {
    with_tensile<typename C::Lists>(c.scene, [&](auto tensile) {
      with_order<S, Real>(c.scene, nullptr, {}, [&](const auto& order) {
        f(lambda_pass<S, true>(of_lambda, lists, order, c.p.boundary),
          delta_pass<S, decltype(tensile)::value>(of_delta, lists, of_delta[field::density],
                                                  nullptr, NoLevelMove<Real>{}, order,
                                                  c.p.boundary));
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
    with_turns(c, typename Exec::TurnLists{c.lists}, [&](const auto& first, const auto& second) {
      c.exec.turn(c.rows(), lambda, first, second);
    });
    return true;
  } else {
    return false;
  }
}

/// Runs the iterations of `round`, and before them makes lists if `makes_lists`. False if the
/// executor does not do that in one launch; then nothing has run.
template <class C>
bool take_turns(C& c, const ProgramStep& round, bool makes_lists) {
  bool taken = false;
  if (!c.plan.turns || round.kind != ProgramStep::iterate) return false;
  using Exec = std::remove_reference_t<decltype(c.exec)>;
  const typename Exec::TurnLists lists{makes_lists ? c.exec.prepare_lists(c.capacity()) : c.lists};
  with_turns(c, lists, [&](const auto& lambda, const auto& delta) {
    taken = c.exec.turns(
        c.rows(), makes_lists, c.data(field::bin_start), lambda, delta,
        std::span(c.factors).subspan(std::size_t(round.first), std::size_t(round.times)));
  });
  if (!taken) return false;
  if (makes_lists) c.take_lists(lists);
  c.iterations += round.times;
  return true;
}
/// Runs steps[k] in one launch, where the executor can; k is then the last step that ran with it.
template <class C>
bool take_turns(C& c, const Steps& steps, std::size_t& k) {
  if constexpr (has_turns<C>) {
    if constexpr (has_ranks<C>)
      if (c.exec.rows()) return false;  // they exchange rows between passes
    const bool makes_lists = steps[k].kind == ProgramStep::pass &&
                             steps[k].index == C::Passes::template index_of<MakeLists>();
    if (makes_lists && k + 1 < steps.size() && take_turns(c, steps[k + 1], true)) return ++k;
    return take_turns(c, steps[k], false);
  } else {
    return false;
  }
}

}  // namespace pbf::PBF_VARIANT
