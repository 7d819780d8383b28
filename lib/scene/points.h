// Visits the positions of a body's particles in the order of their ids, before any check. Header
// only. particle_file.h reads bodies that are files.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "lib/scene/lattice.h"
#include "lib/scene/random.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {

/// Of a cylinder: two directions normal to its axis, and the axis. Parallel to the axes of the
/// scene if the cylinder's axis is, so that its lattice is that of blocks.
inline std::array<Double3, 3> cylinder_frame(const Body& body) {
  const Double3 axis = unit(body.to - body.from);
  // Start from the axis of the scene with the smallest component along the cylinder's axis.
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::fabs(axis[a]) < std::fabs(axis[least])) least = a;
  Double3 other{};
  other[least] = 1;
  const Double3 first = unit(other - dot(other, axis) * axis);
  return {first, cross(axis, first), axis};
}

/// Calls put(position in m) for every particle of a block, sphere, cylinder or random box. d:
/// spacing of the lattice; plane: Scene::plane(); the caller moves the y of particles onto it.
template <class Put>
void for_each_point(const Body& body, double d, std::optional<double> plane, Put&& put) {
  if (body.shape == Shape::block) {
    const auto cells = block_cells(body, d, plane);
    const std::array<std::int64_t, 3> n{static_cast<std::int64_t>(cells[0]),
                                        static_cast<std::int64_t>(cells[1]),
                                        static_cast<std::int64_t>(cells[2])};
    for (std::int64_t k = 0; k < n[2]; ++k)
      for (std::int64_t j = 0; j < n[1]; ++j)
        for (std::int64_t i = 0; i < n[0]; ++i)
          put(Double3{body.min[0] + (static_cast<double>(i) + 0.5) * d,
                      body.min[1] + (static_cast<double>(j) + 0.5) * d,
                      body.min[2] + (static_cast<double>(k) + 0.5) * d});
  }
  if (body.shape == Shape::sphere) {
    const double limit = sphere_limit(body, d, plane);
    const std::int64_t n = half_width(limit), ny = plane ? 0 : n;
    for (std::int64_t k = -n; k <= n; ++k)
      for (std::int64_t j = -ny; j <= ny; ++j) {
        const auto w = half_width(limit - static_cast<double>(k * k) - static_cast<double>(j * j));
        for (std::int64_t i = -w; i <= w; ++i)
          put(Double3{body.center[0] + static_cast<double>(i) * d,
                      body.center[1] + static_cast<double>(j) * d,
                      body.center[2] + static_cast<double>(k) * d});
      }
  }
  if (body.shape == Shape::cylinder) {
    const auto frame = cylinder_frame(body);
    const double limit = disc_limit(body, d);
    const std::int64_t n = half_width(limit);
    const auto discs = static_cast<std::int64_t>(disc_count(body, d, plane));
    for (std::int64_t k = 0; k < discs; ++k)
      for (std::int64_t j = -n; j <= n; ++j) {
        const auto w = half_width(limit - static_cast<double>(j * j));
        for (std::int64_t i = -w; i <= w; ++i)
          put(body.from + (static_cast<double>(i) * d) * frame[0] +
              (static_cast<double>(j) * d) * frame[1] +
              ((static_cast<double>(k) + 0.5) * d) * frame[2]);
      }
  }
  if (body.shape == Shape::random_box) {
    SplitMix64 random(body.seed);
    for (std::int64_t i = 0; i < body.count; ++i) {
      Double3 x{};
      for (int a = 0; a < 3; a += plane ? 2 : 1)
        // min(): rounding may put the product above the upper face
        x[a] = std::min(body.min[a] + random.uniform() * (body.max[a] - body.min[a]), body.max[a]);
      put(x);
    }
  }
}

}  // namespace pbf::scene_module
