// Density and lambda from packed positions (packed_position.h): a gather of 8 bytes for each
// neighbor instead of 16.
#pragma once

#include "kernels/packed_position.h"
#include "kernels/pass_lambda.h"

namespace pbf::PBF_VARIANT {

/// As LambdaPass with the density. Walls and results are at the positions themselves.
template <class Lists, Smoothing S, class Order, class Boundary>
struct PackedLambdaPass : LambdaPass<float, Lists, S, true, Order, Boundary> {
  using Base = LambdaPass<float, Lists, S, true, Order, Boundary>;
  using Own = PackedPosition;
  using Sum = typename Base::Sum;  ///< the gradient in steps of the ring
  GatheredRows<PackedPosition> packed;
  static constexpr bool of_many = true;  ///< one thread computes a sum, always

  PBF_HD auto own(int i) const { return load(packed, i); }
  PBF_HD auto other(Neighbor j) const { return load(packed, j); }
  PBF_HD void add(Sum& s, const Own& a, const Own& b) const {
    const Vec3<float> d = packed_steps(a, b);
    Base::add_pair(s, d, pads_lists(b) ? 1.f : kRingStep * kRingStep * dot(d, d));
  }
  PBF_HD void finish(int i, const Own&, Sum s) const {
    s.gradient = kRingStep * s.gradient;
    Base::finish(i, point<3>(load(this->position, i)), s);
  }
};

}  // namespace pbf::PBF_VARIANT
