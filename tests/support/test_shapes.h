// Shapes that are no program's: what the kernels make of a distance is tried with them.
#pragma once

#include <cmath>

#include "kernels/shapes/shape.h"

namespace pbf_test {

using pbf::Bounds;
using pbf::Vec3;

inline Vec3<double> unit_of(const Vec3<double>& v) { return (1 / std::sqrt(pbf::dot(v, v))) * v; }

/// Half axes a; the nearest place by bisection. With D = 2 its section where y is 0.
template <class Real>
struct Ellipsoid {
  static constexpr bool convex = true;
  Vec3<Real> a;

  template <class To>
  Ellipsoid<To> scaled(double by) const {
    return {pbf::scaled<To>(a, by)};
  }
  static Vec3<double> nudged(Vec3<Real> p) {  // off the axes, where two places are as near
    const auto off = [](Real x) {
      return std::copysign(std::max(std::fabs(double(x)), 1e-12), double(x));
    };
    return {off(p.x), off(p.y), off(p.z)};
  }
  template <int D>
  Vec3<double> foot(Vec3<Real> p) const {
    const Vec3<double> x = nudged(p), s{double(a.x * a.x), double(a.y * a.y), double(a.z * a.z)};
    const auto at = [&](double t) {
      return Vec3<double>{s.x * x.x / (s.x + t), D == 3 ? s.y * x.y / (s.y + t) : 0,
                          s.z * x.z / (s.z + t)};
    };
    const double least = std::min({s.x, D == 3 ? s.y : s.x, s.z});
    double low = -least, high = 10 + 10 * pbf::dot(x, x) + 10 * (s.x + s.y + s.z);
    for (int k = 0; k < 90; ++k) {
      const double t = 0.5 * (low + high);
      const Vec3<double> y = at(t);
      (y.x * y.x / s.x + y.y * y.y / s.y + y.z * y.z / s.z > 1 ? low : high) = t;
    }
    return at(high);
  }
  template <int D>
  Vec3<double> gradient(Vec3<Real> p) const {
    const Vec3<double> y = foot<D>(p);
    return {y.x / (a.x * a.x), y.y / (a.y * a.y), y.z / (a.z * a.z)};
  }
  template <int D>
  Real distance(Vec3<Real> p) const {
    const Vec3<double> x = nudged(p), y = foot<D>(p);
    const double there =
        x.x * x.x / (a.x * a.x) + (D == 3 ? x.y * x.y / (a.y * a.y) : 0) + x.z * x.z / (a.z * a.z);
    Vec3<double> d = x - y;
    if (D == 2) d.y = 0;
    return Real(std::copysign(std::sqrt(pbf::dot(d, d)), there - 1));
  }
  template <int D>
  Vec3<Real> normal(Vec3<Real> p) const {
    return pbf::scaled<Real>(unit_of(gradient<D>(p)), 1);
  }
  /// Of the level set (x/a)^2 + ... = 1: the trace of its second derivative across the normal.
  template <int D>
  Real curvature(Vec3<Real> p) const {
    const Vec3<double> g = gradient<D>(p), n = unit_of(g);
    const Vec3<double> i{1 / double(a.x * a.x), 1 / double(a.y * a.y), 1 / double(a.z * a.z)};
    const double trace = i.x + (D == 3 ? i.y : 0) + i.z,
                 along = n.x * n.x * i.x + n.y * n.y * i.y + n.z * n.z * i.z;
    return Real((trace - along) / ((D - 1) * std::sqrt(pbf::dot(g, g))));
  }
  Bounds<Real> bounds() const { return {Real(-1) * a, a}; }
};

/// Of another shape its distance alone: what has no closed form.
template <class Shape, class Real = double>
struct Bare {
  static constexpr bool convex = Shape::convex;
  Shape shape;

  template <class To>
  auto scaled(double by) const {
    return Bare<decltype(shape.template scaled<To>(by)), To>{shape.template scaled<To>(by)};
  }
  template <int D>
  Real distance(Vec3<Real> p) const {
    return shape.template distance<D>(p);
  }
  template <int D>
  Vec3<Real> normal(Vec3<Real> p) const {
    return shape.template normal<D>(p);
  }
  Bounds<Real> bounds() const { return shape.bounds(); }
};

/// Two balls in one: not convex. The normal is that of the nearer one.
template <class Real>
struct TwoBalls {
  static constexpr bool convex = false;
  Real radius, apart;  ///< of their centres, along x

  template <class To>
  TwoBalls<To> scaled(double by) const {
    return {To(by * radius), To(by * apart)};
  }
  Vec3<Real> away(Vec3<Real> p) const { return {p.x - (p.x < 0 ? -apart : apart) / 2, p.y, p.z}; }
  template <int>
  Real distance(Vec3<Real> p) const {
    return std::sqrt(pbf::dot(away(p), away(p))) - radius;
  }
  template <int>
  Vec3<Real> normal(Vec3<Real> p) const {
    const Vec3<Real> d = away(p);
    return (Real(1) / std::sqrt(pbf::dot(d, d))) * d;
  }
  Bounds<Real> bounds() const {
    const Real x = radius + apart / 2;
    return {{-x, -radius, -radius}, {x, radius, radius}};
  }
};

}  // namespace pbf_test
