// The view that a scene asks for.
#include <algorithm>
#include <cmath>

#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "lib/render/renderer.h"
#include "lib/scene/vector3.h"

namespace pbf::inline render_module {
namespace {

std::vector<Solid<double>> solids_in_metres(const Scene& scene, double time) {
  const double h = scene.h();
  const auto [x, y, z] = scene.origin();
  std::vector<Solid<double>> solids = solids_of(scene, time);
  for (Solid<double>& s : solids) {
    s.center = Vec3<double>{x, y, z} + h * s.center;
    s.half = h * s.half;
  }
  return solids;
}

}  // namespace

View view_of(const Scene& scene, std::int64_t particles) {
  const Render render = scene.render.value_or(Render{});
  View view;
  view.domain_min = scene.domain.min;
  view.domain_max = scene.domain.max;
  view.flat = scene.dimensions == 2;
  const double g = length(scene.gravity);
  if (g > 0) view.up = (-1 / g) * scene.gravity;
  view.radius = render.radius > 0 ? render.radius : 0.5 * scene.fluid.spacing;
  view.style = render.style;
  view.color = render.color;
  view.rest_density = scene.fluid.rest_density;
  view.size = render.size;
  view.camera = render.camera;
  view.solids = solids_in_metres(scene, 0);
  if (has_moving_obstacles(scene))
    view.solids_at = [scene](double time) { return solids_in_metres(scene, time); };
  for (int k = 0; k < 3; ++k)
    view.open[k] = {scene.domain.is_open(k, false), scene.domain.is_open(k, true)};
  if (render.range) {
    view.range = *render.range;
  } else if (render.color == ColorBy::density) {
    view.range = {0.9 * scene.fluid.rest_density, 1.1 * scene.fluid.rest_density};
  } else if (render.color == ColorBy::compression) {
    view.range = {0, 0.01};
  } else if (render.color == ColorBy::id) {
    view.range = {0.0, static_cast<double>(std::max<std::int64_t>(particles - 1, 1))};
  } else {
    // Free fall through the whole box, on top of the fastest body's own speed.
    double fall = 0, start = 0;
    for (std::size_t k = 0; k < 3; ++k)
      fall += std::abs(view.up[k]) * (scene.domain.max[k] - scene.domain.min[k]);
    for (const auto& body : scene.bodies) start = std::max(start, length(body.velocity));
    const double fastest = std::sqrt(start * start + 2 * g * fall);
    view.range = {0.0, fastest > 0 ? fastest : 1.0};
  }
  return view;
}

}  // namespace pbf::inline render_module
