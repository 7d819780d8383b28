// XSPH viscosity from packed rows (packed_motion.h): one gather for each neighbor instead of two.
#pragma once

#include "kernels/packed_motion.h"
#include "kernels/pass_xsph.h"

namespace pbf::PBF_VARIANT {

/// As XsphPass. The particle's own part of a pair is of its packed row, too, so that both particles
/// of a pair find the same term with opposite signs, and momentum is kept.
template <class Lists, Smoothing S, class Order, class Boundary>
struct PackedXsphPass : XsphPass<float, Lists, S, Order, Boundary> {
  using Base = XsphPass<float, Lists, S, Order, Boundary>;
  using Own = Vec4<float>;
  using Sum = typename Base::Sum;
  GatheredRows<Vec4<float>> motion;      ///< packed_motion() of each particle
  static constexpr bool of_many = true;  ///< see PackedLambdaPass

  PBF_HD auto own(int i) const { return load(motion, i); }
  PBF_HD auto other(Neighbor j) const { return load(motion, j); }
  PBF_HD void add(Sum& s, const Own& a, const Vec4<float>& b) const {
    Base::add_pair(s, packed_distance(a, b), packed_inverse_densities(a, b),
                   packed_way_steps(b, a));
  }
  PBF_HD void finish(int i, const Own&, const Sum& s) const {
    const float speed = kRingStep * this->p.inv_dt;
    Base::finish(i, xsph_own<3>(load(this->position, i), load(this->velocity, i)),
                 Sum{speed * s.v});
  }
};

}  // namespace pbf::PBF_VARIANT
