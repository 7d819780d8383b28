// The sponges of a scene (key `damping`) in the internal frame.
#pragma once

#include <cmath>

#include "kernels/pass_sponge.h"
#include "kernels/shapes/shape.h"
#include "lib/program/plan.h"
#include "lib/scene/sponge.h"
#include "lib/scene/surface.h"

namespace pbf::PBF_VARIANT {

/// Zone k of scene.damping. Two-dimensional scenes have no ends along y.
template <class Real>
SpongeZone<Real> sponge_zone(const Scene& s, const Axes& axes, std::size_t k) {
  const Sponge& from = s.damping[k];
  const int face = face_named(from.toward), along = face / 2;
  const double h = s.h(), edge = (from.max[std::size_t(along)] - from.min[std::size_t(along)]) / h;
  const Vec3<double> a0 = internal_place(s, axes, from.min), a1 = internal_place(s, axes, from.max);
  const double low[3] = {a0.x, a0.y, a0.z}, high[3] = {a1.x, a1.y, a1.z};
  double lower[3], upper[3], rise[3] = {0, 0, 0}, damped[3], start = 0;
  for (int a = 0; a < 3; ++a) {
    const bool flat = s.dimensions == 2 && axes.of[a] == 1;
    lower[a] = flat ? -kEndless : std::min(low[a], high[a]);
    upper[a] = flat ? kEndless : std::max(low[a], high[a]);
    damped[a] = damps(from, axes.of[a]) ? 1 : 0;
    if (axes.of[a] != along) continue;
    rise[a] = (face % 2 == 1 ? 1 : -1) / edge;
    start = -rise[a] * (face % 2 == 1 ? lower[a] : upper[a]);
  }
  const auto vec = [](const double(&x)[3]) {
    return Vec3<Real>{Real(x[0]), Real(x[1]), Real(x[2])};
  };
  return {vec(lower),   vec(upper), vec(rise), Real(start), Real(sponge_rate(s, from)),
          from.profile, vec(damped)};
}

}  // namespace pbf::PBF_VARIANT
