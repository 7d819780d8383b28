// The axes of the internal frame: a pure function of the scene.
#pragma once

#include "kernels/axes.h"
#include "kernels/vec3.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Bins are numbered with internal x fastest and z slowest, so a slab of the grid along z is a
/// range of rows. z is the longest edge of the box, x the longer one of the others. Among equal
/// edges (to 1e-9), z is the one with the weakest gravity along it, or else the last; x is the
/// first. In two dimensions y stays the thickness.
Axes internal_axes(const Scene& scene);

/// The scene with domain, faces and gravity along the internal axes. Bodies and obstacles are not
/// converted.
Scene in_internal_axes(const Scene& scene, const Axes& axes);

/// A vector of the scene along the internal axes, and the reverse.
inline Vec3<double> along_internal(const Axes& axes, const Double3& v) {
  const auto of = [&](int k) { return v[std::size_t(axes.of[k])]; };
  return {of(0), of(1), of(2)};
}
inline Double3 along_scene(const Axes& axes, const Vec3<double>& v) {
  Double3 out{};
  out[std::size_t(axes.of[0])] = v.x;
  out[std::size_t(axes.of[1])] = v.y;
  out[std::size_t(axes.of[2])] = v.z;
  return out;
}
/// A place of the scene (m) in the internal frame, h; in two dimensions with y = 0.
Vec3<double> internal_place(const Scene& scene, const Axes& axes, const Double3& at);

/// "x, z, y": the axes of the scene that become internal x, y, z.
std::string axes_text(const Axes& axes);

}  // namespace pbf::program_module
