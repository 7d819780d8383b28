#include "tests/oracle/n2_solids.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/oracle/n2_update.h"

namespace oracle {
namespace {

const Real kPi = 3.141592653589793238462643383279502884L;

V body(const Solid& o, const V& x, int dimensions) {
  V p{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k)
      if (dimensions == 3 || k != 1) p[r] += o.axes[r][k] * (x[k] - o.center[k]);
  return p;
}

/// Gauss' rule with 8 nodes: exact for polynomials of degree 15.
Real integral(const std::function<Real(Real)>& f, Real a, Real b) {
  static const Real node[4] = {
      0.183434642495649804939476142360183981L, 0.525532409916328985817739049189246349L,
      0.796666477413626739591553936475830437L, 0.960289856497536231683560868569472990L};
  static const Real weight[4] = {
      0.362683783378361982965150449277195612L, 0.313706645877887287337962201986601313L,
      0.222381034453374470544355994426240884L, 0.101228536290376259152531354309962190L};
  Real sum = 0;
  for (int k = 0; k < 4; ++k)
    for (const Real s : {-node[k], node[k]})
      sum += weight[k] * f(0.5L * (a + b) + 0.5L * (b - a) * s);
  return 0.5L * (b - a) * sum;
}

/// Shares of the unit kernel, lengths in its range.
struct Shares {
  bool poly6, flat;

  Real kernel(Real r) const {
    if (flat) return poly6 ? 4 / kPi * powl(1 - r * r, 3) : 10 / kPi * powl(1 - r, 3);
    return poly6 ? 315 / (64 * kPi) * powl(1 - r * r, 3) : 15 / kPi * powl(1 - r, 3);
  }
  Real half_space(Real q) const {
    if (q < 0) return 1 - half_space(-q);
    if (q >= 1) return 0;
    if (flat) return half_plane_share(poly6, q);
    return integral([&](Real r) { return kernel(r) * 2 * kPi * r * (r - q); }, q, 1);
  }
  /// Between two planes of which x is `above` the upper and `below` the lower one.
  Real slab(Real above, Real below) const { return half_space(above) - half_space(-below); }

  /// Shells about the place: those wholly inside, then those that the ball cuts.
  Real ball(Real c, Real radius) const {
    const Real first = std::min<Real>(fabsl(c - radius), 1), last = std::min<Real>(c + radius, 1);
    Real sum = 0;
    if (c < radius) sum = integral([&](Real r) { return kernel(r) * 4 * kPi * r * r; }, 0, first);
    if (first < last)
      sum += integral(
          [&](Real r) { return kernel(r) * kPi * r / c * (radius * radius - (c - r) * (c - r)); },
          first, last);
    return sum;
  }

  Real moment(Real q) const {
    const Real a = fabsl(q);
    if (a >= 1) return 0;
    if (!flat) return integral([&](Real r) { return kPi * (r * r - q * q) * kernel(r) * r; }, a, 1);
    if (poly6)
      return integral([&](Real y) { return y * y * kernel(sqrtl(q * q + y * y)); }, 0,
                      sqrtl(1 - q * q));
    const Real c0 = 0.053018L, c2 = 0.117286L, c3 = -0.269259L;
    return powl(1 - a, 4) * (c0 + 4 * c0 * a + c2 * a * a + c3 * a * a * a);
  }
  Real round(Real q, Real radius, Real bend) const {
    const Real k = flat ? bend : (1 + bend) / 2, b = flat ? 0.75L : (3 + bend) / 4;
    return std::max<Real>(
        half_space(q) -
            k * moment(q) / std::max({radius + b * q, radius / 4, static_cast<Real>(1e-3L)}),
        0);
  }
};

Real step(Real z) {
  const Real s = std::clamp<Real>(z / 0.88L + 0.5L, 0, 1);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

Real share_of(const Solid& o, const V& x, bool poly6, const Settings& c) {
  const Shares w{poly6, c.dimensions == 2};
  const Real range = c.h * c.wall_range, radius = o.half[0] / range;
  V p = body(o, x, c.dimensions), above{}, below{};
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] /= range;
    above[k] = p[k] - o.half[k] / range;
    below[k] = -o.half[k] / range - p[k];
  }
  const Real end = std::max({above[2], below[2], Real(0)}), axis = hypotl(p[0], p[1]);
  switch (o.shape) {
    case Solid::Shape::plane:
      return w.half_space(p[2]);
    case Solid::Shape::sphere:
      return w.flat ? w.round(hypotl(axis, p[2]) - radius, radius, 1)
                    : w.ball(hypotl(axis, p[2]), radius);
    case Solid::Shape::box: {
      Real all = 1, outside = 0;
      for (std::size_t k = 0; k < 3; k += w.flat ? 2 : 1) {
        all *= w.slab(above[k], below[k]);
        outside += powl(std::max({above[k], below[k], Real(0)}), 2);
      }
      return outside < 1 ? all : 0;
    }
    case Solid::Shape::cylinder: {
      if (w.flat) return w.round(axis - radius, radius, 1);
      const Real side = std::max<Real>(axis - radius, 0);
      if (side * side + end * end >= 1) return 0;
      return w.round(axis - radius, radius, 0) * w.slab(above[2], below[2]);
    }
    case Solid::Shape::capsule:
      break;
  }
  return w.round(hypotl(axis, end) - radius, radius, step(above[2]) + step(below[2]));
}

template <class F>
V gradient(const V& x, Real e, int dimensions, F f) {
  V g{};
  for (std::size_t k = 0; k < 3; k += dimensions == 2 ? 2 : 1) {
    const auto at = [&](Real way) {
      V y = x;
      y[k] += way;
      return f(y);
    };
    g[k] = (8 * (at(e) - at(-e)) - (at(2 * e) - at(-2 * e))) / (12 * e);
  }
  return g;
}

V between(const V& a, const V& b, Real t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

void keep_out(const Solid& o, const V& from, V& to, const Settings& c) {
  const auto depth = [&](Real t) { return level(o, between(from, to, t), c.dimensions); };
  if (depth(0) > hypotl(hypotl(to[0] - from[0], to[1] - from[1]), to[2] - from[2])) return;
  Real low = 0, high = 1;  // the deepest place of the way: levels are convex
  for (int i = 0; i < 120; ++i) {
    const Real s = (2 * low + high) / 3, t = (low + 2 * high) / 3;
    (depth(s) < depth(t) ? high : low) = depth(s) < depth(t) ? t : s;
  }
  Real outside = 0, inside = (low + high) / 2;
  if (depth(1) < depth(inside)) inside = 1;
  if (depth(inside) >= 0) return;
  for (int i = 0; i < 80; ++i) {
    const Real t = (outside + inside) / 2;
    (depth(t) < 0 ? inside : outside) = t;
  }
  const V contact = between(from, to, outside);
  const V n = gradient(contact, 1e-6L * c.h, c.dimensions,
                       [&](const V& y) { return level(o, y, c.dimensions); });
  Real behind = 0;
  for (std::size_t k = 0; k < 3; ++k) behind += n[k] * (contact[k] - to[k]);
  if (behind > 0)
    for (std::size_t k = 0; k < 3; ++k) to[k] += behind * n[k];
}

}  // namespace

Real level(const Solid& o, const V& x, int dimensions) {
  const V p = body(o, x, dimensions);
  const Real end = fabsl(p[2]) - o.half[2], axis = hypotl(p[0], p[1]);
  switch (o.shape) {
    case Solid::Shape::plane:
      return p[2];
    case Solid::Shape::sphere:
      return hypotl(axis, p[2]) - o.half[0];
    case Solid::Shape::box:
      return std::max(
          {fabsl(p[0]) - o.half[0], dimensions == 2 ? end : fabsl(p[1]) - o.half[1], end});
    case Solid::Shape::cylinder:
      return dimensions == 2 ? axis - o.half[0] : std::max(axis - o.half[0], end);
    case Solid::Shape::capsule:
      break;
  }
  return hypotl(axis, std::max<Real>(end, 0)) - o.half[0];
}

Real share(const V& x, bool poly6, const Settings& c) {
  Real sum = 0;
  for (const Solid& o : c.solids)
    if (level(o, x, c.dimensions) < c.h * c.wall_range) sum += share_of(o, x, poly6, c);
  return sum;
}

V share_gradient(const V& x, bool poly6, const Settings& c) {
  // So short because derivatives of higher order jump at the surface, where many particles are.
  return gradient(x, 1e-7L * c.h, c.dimensions, [&](const V& y) { return share(y, poly6, c); });
}

V path_end(const V& from, V to, const Settings& c) {
  for (const Solid& o : c.solids) keep_out(o, from, to, c);
  return to;
}

}  // namespace oracle
