// How far two solids overlap.
#pragma once

#include "kernels/boundary/obstacle.h"
#include "lib/scene/body_box.h"

namespace pbf::scene_module {

/// The extents of a solid along the axes of the scene, in h from its origin; infinite for a plane,
/// and along y of a scene in two dimensions.
BodyBox extents_of(const Scene& scene, const Solid<double>& solid);

/// The domain in the same form.
BodyBox extents_of(const Scene& scene);

/// Thickness of the overlap of two solids in the domain, h: the diameter of its largest inscribed
/// ball; 0 if below `least`. The solids are convex, so descent finds the center of this ball; of
/// others it finds one that may be smaller.
double shared_thickness(const Scene& scene, const Solid<double>& a, const Solid<double>& b,
                        double least);

}  // namespace pbf::scene_module
