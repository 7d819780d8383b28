#include "lib/scene/free_start.h"

#include <fmt/core.h>
#include <algorithm>

#include "lib/scene/surface.h"

namespace pbf::scene_module {
namespace {

/// Places on the surface of a mesh, h from the scene's origin: its vertices, and the middles of its
/// triangles. None for other shapes.
std::vector<Vec3<double>> places_on(const Scene& s, const Obstacle& o, const Solid<double>& solid) {
  std::vector<Vec3<double>> all;
  if (!o.surface_file()) return all;
  const SolidMesh& surface = *o.surface_file()->surface;
  const TriangleMesh& mesh = surface.mesh();
  const auto add = [&](const Double3& x) {
    const Double3 p = (o.meters() / s.h()) * (x - surface.middle());
    all.push_back(solid.center + turned_back<3>(solid, Vec3<double>{p[0], p[1], p[2]}));
  };
  for (const Double3& x : mesh.vertex) add(x);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    add((1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)));
  return all;
}

BodyBox box_about(const Scene& s, const Solid<double>& solid,
                  const std::vector<Vec3<double>>& places) {
  if (places.empty()) return extents_of(s, solid);
  BodyBox box = kNoBox;
  for (const Vec3<double>& x : places) box.add({{x.x, x.y, x.z}, {x.x, x.y, x.z}});
  return box;
}

/// h: how deep the deepest of the places in the domain is in a solid.
double deepest(const Scene& s, const std::vector<Vec3<double>>& places, const Solid<double>& in) {
  const BodyBox domain = extents_of(s);
  double depth = 0;
  for (const Vec3<double>& x : places)
    if (domain.holds({x.x, x.y, x.z}, 0)) depth = std::max(depth, -distance<3>(in, x));
  return depth;
}

}  // namespace

BodyMoments moments_of(const Scene& s, const Obstacle& o) {
  return std::visit(
      [&](const auto& keys) {
        if constexpr (requires { keys.moments(false); }) return keys.moments(s.dimensions == 2);
        return BodyMoments{};
      },
      o.shape);
}

std::string light_text(const Scene& s, const Obstacle& o) {
  const double rest = s.fluid.rest_density, volume = moments_of(s, o).volume,
               density = o.free->density_in(volume);
  const double least = kLeastDensity * rest;
  if (density >= least) return "";
  const std::string what = o.free->density
                               ? fmt::format("is {:.4g} kg/m^3", density)
                               : fmt::format("makes a density of {:.4g} kg/m^3", density);
  return fmt::format(
      "{}, {:.2g} of fluid.rest_density: the fluid would throw about so light a body, whose "
      "coupling to it is tested down to {}; give at least {:.4g}{}",
      what, density / rest, kTestedDensity, o.free->density ? least : least * volume,
      o.free->density ? ""
      : s.plane()     ? " kg/m"
                      : " kg");
}

NamedSolid named_solid(const Scene& s, std::size_t k) {
  Solid<double> solid = solid_in_metres(s.obstacles[k], s);
  const Double3 o = s.origin();
  const double by = 1 / s.h();
  solid.center = by * (solid.center - Vec3<double>{o[0], o[1], o[2]});
  solid.shape = solid.shape.with(
      [&](const auto& body) { return SomeShape<double>(body.template scaled<double>(by)); });
  return {fmt::format("obstacles[{}] ({})", k, s.obstacles[k].name), solid};
}

std::string free_start_text(const Scene& s, const Obstacle& body, const Solid<double>& solid,
                            const std::vector<NamedSolid>& others) {
  const double h = s.h(), slack = touching(s) / h;
  const std::vector<Vec3<double>> places = places_on(s, body, solid);
  const BodyBox box = box_about(s, solid, places), domain = extents_of(s);
  for (int face = 0; face < 6; ++face) {
    const auto a = std::size_t(face / 2);
    const bool high = face % 2 == 1;
    if ((s.plane() && a == 1) || !s.domain.has_wall(face / 2, high)) continue;
    const double behind = high ? box.high[a] - domain.high[a] : -box.low[a];
    if (behind > slack)
      return fmt::format(
          "the body reaches {:.3g} m through the wall {} at the start, where nothing holds it; "
          "move it in, or make it smaller",
          behind * h, kFaceNames[std::size_t(face)]);
  }
  for (const NamedSolid& other : others) {
    const double thick =
        std::max(shared_thickness(s, solid, other.solid, slack), deepest(s, places, other.solid));
    if (thick > slack)
      return fmt::format(
          "the body overlaps {} by {:.2g} m at the start, and would be thrown out of it; part "
          "them, or let them touch",
          other.name, thick * h);
  }
  return "";
}

}  // namespace pbf::scene_module
