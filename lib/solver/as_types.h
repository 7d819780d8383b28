// Choices of a scene as types, so that no pair loop tests them.
#pragma once

#include <type_traits>

#include "kernels/smoothing.h"
#include "lib/scene/scene.h"

namespace pbf::inline PBF_VARIANT {

/// Calls f with the smoothing functions as an integral_constant.
template <class F>
void with_smoothing(KernelMode mode, F&& f) {
  if (mode == KernelMode::paper)
    f(std::integral_constant<Smoothing, Smoothing::paper>{});
  else
    f(std::integral_constant<Smoothing, Smoothing::consistent>{});
}
template <class F>
void with_bool(bool b, F&& f) {
  b ? f(std::true_type{}) : f(std::false_type{});
}

}  // namespace pbf::inline PBF_VARIANT
