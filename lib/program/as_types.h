// Converts choices of a scene to template arguments.
#pragma once

#include <type_traits>

#include "kernels/smoothing.h"
#include "kernels/time_order.h"
#include "lib/program/time_order.h"
#include "lib/scene/scene.h"

namespace pbf::PBF_VARIANT {

// These call f with choices of the scene as types, so that pair loops need not test them.
template <class F>
void with_dimensions(int dimensions, F&& f) {
  dimensions == 2 ? f(std::integral_constant<int, 2>{}) : f(std::integral_constant<int, 3>{});
}
template <class F>
void with_smoothing(KernelMode mode, int dimensions, F&& f) {
  const auto choose = [&](auto in_space, auto in_plane) {
    dimensions == 2 ? f(in_plane) : f(in_space);
  };
  if (mode == KernelMode::paper)
    choose(std::integral_constant<Smoothing, Smoothing::paper>{},
           std::integral_constant<Smoothing, Smoothing::paper_2d>{});
  else
    choose(std::integral_constant<Smoothing, Smoothing::consistent>{},
           std::integral_constant<Smoothing, Smoothing::consistent_2d>{});
}
/// FirstOrder, or SecondOrder with `free`. damping: in passes that predict.
template <class Real, class F>
void with_order(const Scene& s, Vec4<Real>* free, const DissipationBook& damping, F&& f) {
  is_second_order(s) ? f(SecondOrder<Real>{free, damping}) : f(FirstOrder{damping});
}
/// The same in loops over pairs; the paper's kernels are of first order.
template <Smoothing S, class Real, class F>
void with_order(const Scene& s, Vec4<Real>* free, const DissipationBook& damping, F&& f) {
  if constexpr (is_paper(S))
    f(FirstOrder{damping});
  else
    with_order<Real>(s, free, damping, f);
}
template <class F>
void with_bool(bool b, F&& f) {
  b ? f(std::true_type{}) : f(std::false_type{});
}

}  // namespace pbf::PBF_VARIANT
