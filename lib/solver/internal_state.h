// The particles of a scene in the form of the kernels.
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "kernels/axes.h"
#include "kernels/vec3.h"
#include "lib/scene/particles.h"
#include "lib/scene/scene.h"

namespace pbf::PBF_VARIANT {

/// Empties a vector and gives its memory back (`= {}` would keep it).
template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

/// Positions and velocities of a scene in the internal frame, in the order of ids.
template <class Real>
struct InternalState {
  std::vector<Vec4<Real>> position, velocity;
  std::vector<int> id;
};

/// Converts the particles and frees each of their arrays as soon as it is converted, to keep the
/// peak of memory low.
template <class Real>
InternalState<Real> to_internal(const Scene& s, const Axes& axes, Particles particles) {
  const std::size_t n = particles.size();
  const double h = s.h();
  InternalState<Real> out;
  const Double3 o = s.origin();
  const std::size_t a[3] = {std::size_t(axes.of[0]), std::size_t(axes.of[1]),
                            std::size_t(axes.of[2])};
  out.position.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Double3& x = particles.position[i];
    const auto at = [&](std::size_t k) { return Real((x[k] - o[k]) / h); };
    out.position[i] = {at(a[0]), at(a[1]), at(a[2]), Real(1)};
  }
  release(particles.position);
  out.velocity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Double3& v = particles.velocity[i];
    out.velocity[i] = {Real(v[a[0]] / h), Real(v[a[1]] / h), Real(v[a[2]] / h), Real(0)};
  }
  release(particles.velocity);
  out.id = std::move(particles.ids);
  if (!out.id.empty()) return out;
  out.id.resize(n);
  std::iota(out.id.begin(), out.id.end(), 0);
  return out;
}

}  // namespace pbf::PBF_VARIANT
