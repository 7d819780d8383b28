// Points on the surfaces of a scene's obstacles and walls, in SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// The point of a surface nearest to a given position. With dimensions: 2 it is in the plane.
struct SurfacePlace {
  Double3 point{};      ///< m
  Double3 normal{};     ///< unit vector into the fluid
  double distance = 0;  ///< m, of the given position; negative in the solid
};

/// The obstacle at its position in the scene, m.
Solid<double> solid_in_metres(const Obstacle& obstacle, const Scene& scene);

SurfacePlace nearest_place(const Obstacle& obstacle, const Scene& scene, Double3 at);
/// For a face of the domain, by its index in kFaceNames.
SurfacePlace nearest_place(int face, const Scene& scene, Double3 at);

/// The round side of an obstacle that is nearest to a position, m.
RoundSide<double> round_side(const Obstacle& obstacle, const Scene& scene, const Double3& at);
/// Whether a surface without such a side is bent: of shapes that give `curvature`. The list has
/// none yet.
bool is_bent(const Obstacle& obstacle);

/// The surface of a name: 0 to 5 for a face, 6 + index for an obstacle; empty if unknown.
std::optional<int> surface_named(const Scene& scene, const std::string& name);
/// Null for a face.
const Obstacle* obstacle_of(const Scene& scene, int surface);
/// The surfaces whose loads are recorded.
std::vector<int> loaded_surfaces(const Scene& scene);
/// Whether the scene has a pressure gauge on a wall of the domain.
bool has_pressure_on_wall(const Scene& scene);
SurfacePlace nearest_place_on(int surface, const Scene& scene, const Double3& at);

/// Whether a position can be in fluid: in the domain, up to `slack` (m), and in no obstacle.
bool is_free(const Scene& scene, const Double3& at, double slack = 0);

/// The axis of levels: that of gravity's largest component; z without gravity.
int level_axis(const Scene& scene);
/// The other axes in their order; a single one in two dimensions.
std::vector<int> axes_across_level(const Scene& scene);

}  // namespace pbf::scene_module
