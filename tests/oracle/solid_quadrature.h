// The share of a unit kernel that lies in a convex solid, by quadrature along rays: of the solid it
// knows a convex function that is below 0 inside.
#pragma once

#include <array>
#include <cmath>
#include <functional>

namespace oracle_test {

using Point = std::array<double, 3>;
/// h; below 0 inside, convex, never steeper than 1.
using Level = std::function<double(const Point&)>;

/// int_0^q W(r) r^(dimensions - 1) dr of the unit kernel.
inline double kernel_within(bool poly6, int dimensions, double q) {
  const double pi = std::acos(-1.0), s = q * q;
  if (q >= 1) return dimensions == 2 ? 1 / (2 * pi) : 1 / (4 * pi);
  if (dimensions == 2)
    return poly6 ? 4 / pi * (1 - std::pow(1 - s, 4)) / 8
                 : 10 / pi * s * (0.5 - q + 0.75 * s - 0.2 * s * q);
  return poly6 ? 315 / (64 * pi) * q * s * (1. / 3 - 0.6 * s + 3. / 7 * s * s - s * s * s / 9)
               : 15 / pi * q * s * (1. / 3 - 0.75 * q + 0.6 * s - s * q / 6);
}

/// What the ray from x along the unit vector n has of the kernel in the solid.
inline double ray_share(const Level& level, const Point& x, const Point& n, double range,
                        bool poly6, int dimensions) {
  const auto at = [&](double r) {
    return level({x[0] + r * n[0], x[1] + r * n[1], x[2] + r * n[2]});
  };
  double low = 0, high = range, inside = 0;
  if (at(0) >= 0) {  // the lowest place of a convex function, until one inside is found
    const double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double fa = at(a), fb = at(b);
    for (int i = 0; i < 34 && fa >= 0 && fb >= 0; ++i) {
      if (fa - (a - low) > 0 && fb - (high - b) > 0 && fa - (b - a) > 0) return 0;
      if (fa < fb) {
        high = b, b = a, fb = fa;
        fa = at(a = high - golden * (high - low));
      } else {
        low = a, a = b, fa = fb;
        fb = at(b = low + golden * (high - low));
      }
    }
    if (fa >= 0 && fb >= 0) return 0;
    inside = fa < 0 ? a : b;
  }
  const auto edge = [&](double in, double out) {
    if (at(out) < 0) return out;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (in + out);
      (at(middle) < 0 ? in : out) = middle;
    }
    return in;
  };
  return kernel_within(poly6, dimensions, edge(inside, range) / range) -
         kernel_within(poly6, dimensions, edge(inside, 0) / range);
}

/// `n` parallels (in the plane: 16 n directions).
inline double share_by_rays(const Level& level, const Point& x, double range, bool poly6,
                            int dimensions, int n = 48) {
  const double pi = std::acos(-1.0);
  if (level(x) >= range) return 0;
  double sum = 0;
  if (dimensions == 2) {
    for (int i = 0; i < 16 * n; ++i) {
      const double a = 2 * pi * (i + 0.3) / (16 * n);
      sum += ray_share(level, x, {std::cos(a), 0, std::sin(a)}, range, poly6, 2);
    }
    return sum * 2 * pi / (16 * n);
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double z = -1 + 2 * (i + 0.5) / n, s = std::sqrt(1 - z * z);
      const double a = pi * (j + 0.3 + 0.61 * i) / n;  // parallels are turned against each other
      sum += ray_share(level, x, {s * std::cos(a), s * std::sin(a), z}, range, poly6, 3);
    }
  return sum * 4 * pi / (2.0 * n * n);
}

}  // namespace oracle_test
