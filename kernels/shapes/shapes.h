// A shape of any kind as plain data, the same on host and device.
#pragma once

#include <algorithm>
#include <cstring>

#define PBF_SHAPE_TEXT(path) #path
// clang-format off
#define PBF_SHAPE_FILE(name) PBF_SHAPE_TEXT(kernels/shapes/name.h)
// clang-format on
#include "kernels/shapes/list.h"

namespace pbf::PBF_VARIANT {

/// One of these shapes: its index in the list, and its bytes.
template <class... S>
struct AnyShape {
  int tag = 0;
  alignas(S...) unsigned char bytes[std::max({sizeof(S)...})] = {};

  AnyShape() = default;
  template <class Shape>
  requires(std::is_same_v<Shape, S> || ...) PBF_HD AnyShape(const Shape& shape) {
    int k = 0;
    (void)((std::is_same_v<Shape, S> ? (tag = k, true) : (++k, false)) || ...);
    memcpy(bytes, &shape, sizeof(Shape));
  }
  template <class Shape>
  PBF_HD Shape as() const {
    Shape shape;
    memcpy(&shape, bytes, sizeof(Shape));
    return shape;
  }
  template <class Shape>
  requires(std::is_same_v<Shape, S> || ...) bool is() const {
    int k = 0;
    (void)((std::is_same_v<Shape, S> ? true : (++k, false)) || ...);
    return tag == k;
  }
  /// Returns f(shape); the only function that distinguishes shapes.
  template <class F>
  PBF_HD auto with(F&& f) const {
    return with_one<0, F, S...>(f);
  }

 private:
  template <int k, class F, class First, class... Rest>
  PBF_HD auto with_one(F& f) const {
    if constexpr (sizeof...(Rest) == 0) {
      return f(as<First>());
    } else {
      if (tag == k) return f(as<First>());
      return with_one<k + 1, F, Rest...>(f);
    }
  }
};

namespace shape {
template <template <class> class... S>
struct List {
  template <class Real>
  using Any = AnyShape<S<Real>...>;
};
using All = List<PBF_SHAPES>;
}  // namespace shape

/// Any shape of the list.
template <class Real>
using SomeShape = shape::All::Any<Real>;

}  // namespace pbf::PBF_VARIANT
