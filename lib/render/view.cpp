// The view that a scene asks for.
#include <algorithm>

#include "lib/program/motion.h"
#include "lib/render/box.h"
#include "lib/render/camera.h"
#include "lib/render/reach.h"
#include "lib/render/renderer.h"
#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

/// Cuts the frame at a height along `up`: below it lies no more of the box than is kept.
void cut_frame(View& view, double height) {
  const std::size_t k = vertical_axis(view.up);
  double rest = 0;  // least height that the other axes add
  for (std::size_t a = 0; a < 3; ++a)
    if (a != k) rest += std::min(view.up[a] * view.domain_min[a], view.up[a] * view.domain_max[a]);
  const double at = (height - rest) / view.up[k];
  const double least = 0.02 * (view.domain_max[k] - view.domain_min[k]);
  view.frame = {view.domain_min, view.domain_max};
  auto& [low, high] = *view.frame;
  if (view.up[k] > 0)
    high[k] = std::clamp(at, low[k] + least, high[k]);
  else
    low[k] = std::clamp(at, low[k], high[k] - least);
}

}  // namespace

View view_of(const Scene& scene, std::int64_t particles) {
  const Render render = scene.render.value_or(Render{});
  View view;
  view.domain_min = scene.domain.min;
  view.domain_max = scene.domain.max;
  view.name = scene.name;
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
  for (const Obstacle& o : scene.obstacles) {
    auto& drawn = view.surfaces.emplace_back();
    if (const auto* file = o.surface_file(); file && file->surface)
      drawn = std::make_shared<const std::vector<MeshTriangle>>(
          drawn_triangles(*file->surface, o.meters()));
  }
  if (has_moving_obstacles(scene))
    view.solids_at = [now = scene](double time, const std::vector<BodyMotion>& bodies) mutable {
      place_bodies(now, bodies);
      return solids_in_metres(now, time);
    };
  for (int k = 0; k < 3; ++k)
    view.open[k] = {scene.domain.is_open(k, false), scene.domain.is_open(k, true)};
  const Reach reach = reach_of(scene, view.up, particles);
  // What falls through an open floor is seen on its whole way.
  if (g > 0 && !floor_is_open(view)) cut_frame(view, reach.height + 2 * view.radius);
  if (render.range) {
    view.range = *render.range;
  } else if (render.color == ColorBy::density) {
    view.range = {0.9 * scene.fluid.rest_density, 1.1 * scene.fluid.rest_density};
  } else if (render.color == ColorBy::compression) {
    view.range = {0, 0.01};
  } else if (render.color == ColorBy::id) {
    view.range = {0.0, static_cast<double>(std::max<std::int64_t>(particles - 1, 1))};
  } else {
    view.range = {0.0, reach.speed};
  }
  return view;
}

}  // namespace pbf::render_module
