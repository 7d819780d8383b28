// Hyperviscosity from packed rows (packed_motion.h): one gather for each neighbor instead of two.
#pragma once

#include "kernels/packed_motion.h"
#include "kernels/pass_hyperviscosity.h"

namespace pbf::PBF_VARIANT {

/// As VectorLaplacian, but the vector is in the packed rows. Both particles of a pair find the same
/// term with opposite signs, so the sum over all particles stays 0.
template <class Lists, Smoothing S>
struct PackedLaplacian {
  Params<float> p;
  Lists lists;
  GatheredRows<Vec4<float>> motion;  ///< packed_motion() of each particle

  static constexpr int D = 3;
  static constexpr bool of_many = true;  ///< see PackedLambdaPass
  using Own = Vec4<float>;
  using Sum = VectorSum<float, 3>;  ///< in steps of the ring

  PBF_HD auto own(int i) const { return load(motion, i); }
  PBF_HD auto other(Neighbor j) const { return load(motion, j); }
  PBF_HD void add(Sum& s, const Own& a, const Own& b) const {
    const Vec3<float> d = packed_distance(a, b);
    const float q2 = pads_motion(b) ? 1.f : dot(d, d);
    const float shape =
        density_shape<float, S>(q2, is_paper(S) ? 0.f : Spiky<float>::t(root_of(q2).q));
    s.v = s.v + shape * packed_way_steps(b, a);
  }
  /// Of what was packed.
  PBF_HD Vec3<float> laplacian(const Sum& s) const {
    return (kRingStep * p.vol * density_norm<float, S>()) * s.v;
  }
};

/// f L v as VelocityLaplacianPass. motion: of dt v; out: of f L v / v0, which is not above 1/2.
template <class Lists, Smoothing S>
struct PackedVelocityLaplacianPass : PackedLaplacian<Lists, S> {
  using Base = PackedLaplacian<Lists, S>;
  OwnRows<const Vec4<float>> position;
  OwnRows<Vec4<float>> out;
  PBF_HD void finish(int i, const Vec4<float>&, const typename Base::Sum& s) const {
    const float unit = this->p.inv_dt * square_root(this->p.calm);
    const Vec3<float> l = unit * this->laplacian(s);
    set_row(out, i, packed_motion(xyz(position[i]), (1.f / (1.f + dot(l, l))) * l, 1.f));
  }
};

/// v -= c L (f L v). motion: of f L v / v0.
template <class Lists, Smoothing S>
struct PackedHyperviscosityPass : PackedLaplacian<Lists, S> {
  using Base = PackedLaplacian<Lists, S>;
  OwnRows<Vec4<float>> velocity;  ///< in/out, h/s
  DissipationBook book;
  PBF_HD void finish(int i, const Vec4<float>&, const typename Base::Sum& s) const {
    const float c = this->p.hyperviscosity / square_root(this->p.calm);
    const Vec3<float> v = xyz(row(velocity, i)), now = v - c * this->laplacian(s);
    set_row(velocity, i, with_w(now, 0.f));
    book.add(i, energy_taken(v, now));
  }
};

}  // namespace pbf::PBF_VARIANT
