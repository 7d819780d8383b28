#include "lib/run/surface_warnings.h"

#include <fmt/core.h>

#include "lib/program/obstacles.h"
#include "lib/program/solid_maps.h"
#include "lib/scene/body_box.h"

namespace pbf::run_module {
namespace {

/// h: at this depth below the surface, the map of a part that is thick enough is this far inside.
constexpr double kDepth = 0.25, kInside = 0.1;
constexpr double kPart = 0.05;  // of the surface, which edges and tips may make up

/// The part of a surface below which the solid is too thin, and one place there, m.
struct Thin {
  double part = 0;
  Double3 first{};
};
Thin thin_part(const Scene& s, const Obstacle& o, const Solid<double>& solid) {
  const TriangleMesh& mesh = o.surface_file()->surface->mesh();
  const Double3 middle = o.surface_file()->surface->middle(), from = s.origin();
  const double h = s.h(), by = o.meters() / h;
  const BodyBox domain{s.domain.min, s.domain.max};
  double all = 0, thin = 0;
  Thin out;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Double3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
    const Double3 across = cross(b - a, c - a);
    const double area = length(across);
    if (!(area > 0)) continue;
    const Double3 place = by * ((1.0 / 3) * (a + b + c) - middle) - (kDepth / area) * across;
    const Vec3<double> at = turned_back<3>(solid, Vec3<double>{place[0], place[1], place[2]});
    const Vec3<double> x = solid.center + at;
    const Double3 in_scene{from[0] + h * x.x, from[1] + h * x.y, from[2] + h * x.z};
    if (!domain.holds(in_scene, 0)) continue;
    all += area;
    if (distance<3>(solid, x) < -kInside) continue;
    if (thin == 0) out.first = in_scene;
    thin += area;
  }
  out.part = all > 0 ? thin / all : 0;
  return out;
}

}  // namespace

std::string thin_text(const Scene& scene) {
  if (!has_maps(scene)) return "";
  const std::vector<Solid<double>> solids = solids_of(scene);
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const Obstacle& o = scene.obstacles[k];
    if (!o.surface_file()) continue;
    const Thin thin = thin_part(scene, o, solids[k]);
    if (thin.part < kPart) continue;
    return fmt::format(
        "obstacles[{}] ({}) is thinner than half the smoothing length ({:.3g} m) below {:.2g} % of "
        "its surface, at ({:.3g}, {:.3g}, {:.3g}) for one: fluid may pass there; thicken it, or "
        "lower fluid.spacing",
        k, o.name, 0.5 * scene.h(), 100 * thin.part, thin.first[0], thin.first[1], thin.first[2]);
  }
  return "";
}

}  // namespace pbf::run_module
