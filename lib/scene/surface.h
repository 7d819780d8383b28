// Places on the surfaces of a scene's obstacles and walls, in SI units.
#pragma once

#include <optional>
#include <string>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// The place of a surface that is nearest to another one. With dimensions: 2 in the plane.
struct SurfacePlace {
  Double3 point{};      ///< m
  Double3 normal{};     ///< of length 1, into the fluid
  double distance = 0;  ///< m, of the other place; below 0 in the solid
};

/// The obstacle where its keys put it, m.
Solid<double> solid_in_metres(const Obstacle& obstacle, const Scene& scene);

SurfacePlace nearest_place(const Obstacle& obstacle, const Scene& scene, Double3 at);
/// Of a face of the domain, by its number in kFaceNames.
SurfacePlace nearest_place(int face, const Scene& scene, Double3 at);

/// The round side of an obstacle that is nearest to a place, m.
RoundSide<double> round_side(const Obstacle& obstacle, const Scene& scene, const Double3& at);
/// Whether a surface without such a side is bent: of shapes that give `curvature`. The list has none
/// yet.
bool is_bent(const Obstacle& obstacle);

/// What a name stands for: face 0 to 5, or 6 and the number of the obstacle; nothing for others.
std::optional<int> surface_named(const Scene& scene, const std::string& name);
/// Whether the scene has a pressure gauge on a wall of the domain.
bool has_pressure_on_wall(const Scene& scene);
SurfacePlace nearest_place_on(int surface, const Scene& scene, const Double3& at);

/// Whether fluid may be at a place: in the domain, to `slack` (m), and in no obstacle.
bool is_free(const Scene& scene, const Double3& at, double slack = 0);

/// The axis that levels are read along: that of gravity's largest component, z where there is none.
int level_axis(const Scene& scene);
/// The others in their order; in two dimensions one of them.
std::vector<int> axes_across_level(const Scene& scene);

}  // namespace pbf::inline scene_module
