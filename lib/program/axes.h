// The axes of the internal frame: a pure function of the scene.
#pragma once

#include "kernels/axes.h"
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

/// "x, z, y": the axes of the scene that become internal x, y, z.
std::string axes_text(const Axes& axes);

}  // namespace pbf::program_module
