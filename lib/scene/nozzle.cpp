#include "lib/scene/nozzle.h"

#include <algorithm>
#include <cmath>

namespace pbf::scene_module {
namespace {

/// Columns along an edge: so many whole spacings as fit.
int columns_along(double edge, double spacing) {
  return std::max(int(std::min(edge / spacing * (1 + 1e-9), 1e5)), 0);
}

}  // namespace

int held_layers(const Scene& s) { return int(std::ceil(s.fluid.smoothing_ratio * (1 - 1e-9))); }

double fastest_of(const Emitter& e) {
  double most = e.speed.value_or(0);
  if (!e.speed)
    for (const auto& row : e.table.values) most = std::max(most, row[0]);
  return most;
}

double fastest_emitter(const Scene& s, double from, double to) {
  double most = 0;
  for (const Emitter& e : s.emitters)
    if (e.start <= to && e.end.value_or(s.time.end) >= from) most = std::max(most, fastest_of(e));
  return most;
}

NozzlePlace nozzle_place(const Scene& s, const Emitter& e) {
  NozzlePlace p;
  const bool flat = s.dimensions == 2;
  const double d = s.fluid.spacing;
  p.center = e.center;
  if (flat) p.center[1] = *s.plane();
  p.normal = direction(e.normal);
  const double level = std::hypot(p.normal[0], p.normal[1]);
  p.side[0] = flat           ? Double3{-p.normal[2], 0, p.normal[0]}
              : level > 1e-9 ? unit({-p.normal[1], p.normal[0], 0})
                             : Double3{1, 0, 0};
  p.side[1] = cross(p.normal, p.side[0]);
  const bool disc = e.shape == NozzleShape::disc;
  p.disc = disc && !flat;
  for (std::size_t k = 0; k < 2; ++k)
    p.half[k] = disc ? e.radius : k < e.size.size() ? e.size[k] / 2 : 0;
  if (flat) p.half[1] = s.domain.max[1] - s.domain.min[1];  // all of the slab
  // A layer begins at the start of the update in which the one before leaves the first places.
  p.depth = (held_layers(s) + 0.5) * d + fastest_of(e) * s.time.step;
  p.wall = s.h() - 0.5 * d;
  const auto add = [&](double a, double b) {
    p.column.push_back(p.center + a * p.side[0] + b * p.side[1]);
  };
  if (disc) {
    // From the middle on, half a spacing away from the rim.
    const double most = e.radius - 0.5 * d * (1 - 1e-9);
    const int n = int(std::min(std::max(most, 0.0) / d * (1 + 1e-9), 1e4));
    for (int j = flat ? 0 : -n; j <= (flat ? 0 : n); ++j)
      for (int i = -n; i <= n; ++i)
        if (most >= 0 && std::hypot(i * d, j * d) <= most * (1 + 1e-9)) add(i * d, j * d);
  } else {
    const int across = columns_along(2 * p.half[0], d),
              up = flat ? 1 : columns_along(2 * p.half[1], d);
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < across; ++i) add((i - 0.5 * (across - 1)) * d, (j - 0.5 * (up - 1)) * d);
  }
  return p;
}

bool NozzlePlace::holds(const Double3& x, double margin) const {
  const Double3 off = x - center;
  const double s = dot(off, normal), a = dot(off, side[0]), b = dot(off, side[1]),
               more = wall + margin;
  if (s > margin || s < -length() - margin) return false;
  if (disc) return std::hypot(a, b) <= half[0] + more;
  return std::fabs(a) <= half[0] + more && std::fabs(b) <= half[1] + more;
}

std::vector<Double3> NozzlePlace::places(double apart) const {
  std::vector<Double3> all;
  const auto steps = [&](double length) {
    return std::clamp(int(std::ceil(length / apart)), 1, 64);
  };
  const double a = half[0] + wall, b = half[1] + wall;
  const int na = steps(2 * a), nb = steps(2 * b), ns = steps(length());
  for (int i = 0; i <= na; ++i)
    for (int j = 0; j <= nb; ++j)
      for (int k = 0; k <= ns; ++k) {
        const double u = (2.0 * i / na - 1) * a, v = (2.0 * j / nb - 1) * b;
        const Double3 x = center + u * side[0] + v * side[1] - (length() * k / ns) * normal;
        if (holds(x, 1e-9 * apart)) all.push_back(x);
      }
  return all;
}

std::vector<Double3> NozzlePlace::corners() const {
  std::vector<Double3> all;
  for (const double s : {-depth, 0.0})
    for (const double a : {-half[0], half[0]})
      for (const double b : {-half[1], half[1]})
        all.push_back(center + s * normal + a * side[0] + b * side[1]);
  return all;
}

std::vector<Double3> NozzlePlace::held(double spacing, int layers) const {
  std::vector<Double3> all;
  for (int m = 0; m < layers; ++m)
    for (const Double3& c : column) all.push_back(c - ((m + 0.5) * spacing) * normal);
  return all;
}

}  // namespace pbf::scene_module
