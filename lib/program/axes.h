// The axes of the internal frame: a pure function of the scene.
#pragma once

#include "kernels/axes.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Bins are numbered with internal x fastest and internal z slowest, so a slab of the grid along
/// internal z is a range of rows. z is the longest edge of the box, and x the longer one of the
/// others. Of edges alike (to 1e-9) z takes the one along which gravity is weakest, of these the
/// last; x the first. In two dimensions y stays the thickness.
Axes internal_axes(const Scene& scene);

/// The scene in the internal axes as far as the solver needs it: domain, faces and gravity; bodies
/// stay as they are.
Scene in_internal_axes(const Scene& scene, const Axes& axes);

/// "x, z, y": the scene's axes that internal x, y, z are.
std::string axes_text(const Axes& axes);

}  // namespace pbf::inline program_module
