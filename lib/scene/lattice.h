// The lattices of block, sphere and cylinder bodies, and their numbers of points. Header only.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// Largest number of particles of a scene: ids are 32-bit and signed.
inline constexpr double kMaxParticles = 2147483647.0;

/// Number of whole cells of edge d (m) along each axis of a block. A cell may be short by a
/// millionth of d, because of rounding: (0.4 - 0) / 0.02 need not be 20. Returns doubles, which
/// cannot overflow. `plane`: Scene::plane(); if it is set, there is a single layer along y.
inline std::array<double, 3> block_cells(const Body& body, double d, std::optional<double> plane) {
  std::array<double, 3> n{};
  for (int a = 0; a < 3; ++a) n[a] = std::floor((body.max[a] - body.min[a]) / d + 1e-6);
  if (plane) n[1] = 1;
  return n;
}

/// Squared radius of a sphere in units of d, enlarged by rounding: lattice point (i, j, k) is in
/// the sphere if i^2 + j^2 + k^2 <= sphere_limit. With a plane: that of its disc in the plane (j =
/// 0), negative if the plane misses the sphere.
inline double sphere_limit(const Body& body, double d, std::optional<double> plane) {
  const double r = body.radius / d, off = plane ? (*plane - body.center[1]) / d : 0;
  return r * r * (1 + 1e-9) - off * off;
}

/// Squared radius of a cylinder's discs in units of d, like sphere_limit().
inline double disc_limit(const Body& body, double d) {
  const double r = body.radius / d;
  return r * r * (1 + 1e-9);
}

/// Number of discs of a cylinder, a spacing apart, the first half a spacing from `from`; 1 with a
/// plane. A double, which cannot overflow.
inline double disc_count(const Body& body, double d, std::optional<double> plane) {
  const double length =
      std::hypot(body.to[0] - body.from[0], body.to[1] - body.from[1], body.to[2] - body.from[2]);
  return plane ? 1 : std::floor(length / d + 1e-6);
}

/// Largest k >= 0 with k^2 <= rest, or -1 if rest < 0.
inline std::int64_t half_width(double rest) {
  if (rest < 0) return -1;
  auto k = static_cast<std::int64_t>(std::sqrt(rest));
  while (static_cast<double>(k) * static_cast<double>(k) > rest) --k;
  while (static_cast<double>(k + 1) * static_cast<double>(k + 1) <= rest) ++k;
  return k;
}

/// Number of particles of a body that is not a file; creates none. Exact up to 2^53 for blocks and
/// up to kMaxParticles for spheres and cylinders (beyond that estimated from the volume).
inline double lattice_count(const Body& body, double d, std::optional<double> plane) {
  if (body.shape == Shape::random_box) return static_cast<double>(body.count);
  if (body.shape == Shape::block) {
    const auto n = block_cells(body, d, plane);
    return std::fmax(n[0], 0) * std::fmax(n[1], 0) * std::fmax(n[2], 0);
  }
  // A cylinder is a stack of equal discs; a disc is the cut of a sphere with a plane.
  const bool discs = body.shape == Shape::cylinder, thin = plane || discs;
  const double limit = discs ? disc_limit(body, d) : sphere_limit(body, d, plane);
  const double times = discs ? disc_count(body, d, plane) : 1;
  if (limit < 0) return 0;
  const double volume =
      thin ? 3.14159265358979324 * limit : 4.18879020478639098 * limit * std::sqrt(limit);
  if (volume * times > 2 * kMaxParticles) return volume * times;
  const std::int64_t n = half_width(limit), ny = thin ? 0 : n;
  double sum = 0;
  for (std::int64_t k = -n; k <= n; ++k)
    for (std::int64_t j = -ny; j <= ny; ++j)
      if (const auto w =
              half_width(limit - static_cast<double>(k * k) - static_cast<double>(j * j));
          w >= 0)
        sum += static_cast<double>(2 * w + 1);
  return sum * times;
}

}  // namespace pbf::scene_module
