// Where free bodies may be at the start.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lib/scene/overlap.h"

namespace pbf::scene_module {

/// Of the shape of an obstacle, along its own axes, in m; zeros if it may not be free. A mesh has
/// been read.
BodyMoments moments_of(const Scene& scene, const Obstacle& obstacle);

/// Densities of free bodies, as shares of fluid.rest_density: the least that is allowed, and the
/// least at which their motion has been compared with theory.
inline constexpr double kLeastDensity = 0.01, kTestedDensity = 0.05;
/// That a free body is too light for its fluid, with the remedy; empty: it is not. It has either a
/// density or a mass.
std::string light_text(const Scene& scene, const Obstacle& body);

/// m: so far a free body may be behind a wall or in another solid at the start: places that are
/// meant to touch are rounded.
inline double touching(const Scene& scene) { return 0.05 * scene.fluid.spacing; }

/// An obstacle where its keys put it, or a casing; lengths in h from Scene::origin().
struct NamedSolid {
  std::string name;  ///< "obstacles[0] (gate)"
  Solid<double> solid;
};
NamedSolid named_solid(const Scene& scene, std::size_t obstacle);

/// What is wrong with the place of a free body at the start, with the remedy: it reaches through a
/// wall of the domain, or overlaps one of `others`; empty: nothing. A mesh has been read.
std::string free_start_text(const Scene& scene, const Obstacle& body, const Solid<double>& solid,
                            const std::vector<NamedSolid>& others);

}  // namespace pbf::scene_module
