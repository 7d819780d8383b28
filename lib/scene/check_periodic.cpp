// Rules for scenes with periodic axes.
#include <algorithm>
#include <cmath>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/periodic.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/surface.h"
#include "lib/scene/viscosity.h"

namespace pbf::scene_module {
namespace {

class PeriodicChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    if (!good(s_.domain.periodic) || s_.domain.periodic.empty()) return;
    check_axes();
    const std::vector<int> axes = periodic_axes(s_);
    if (axes.empty()) return;
    for (const int a : axes) check_forces(std::size_t(a));
    if (good(s_.solver.levels) && s_.solver.levels == LevelsMode::on)
      add(s_.solver.levels,
          "the grids of levels end at the faces of the domain, of which domain.periodic joins "
          "some; "
          "give off or auto");
    if (s_.tank_motion && s_.tank_motion->axis)
      add(s_.tank_motion->axis,
          "the forces in a tank that turns depend on the place, so they have no period; give a "
          "direction, or remove domain.periodic");
    if (good(s_.domain.min, s_.domain.max, s_.fluid.spacing, s_.fluid.smoothing_ratio)) {
      for (const int a : axes) check_length(std::size_t(a));
      for (const Gauge& g : s_.gauges)
        if (good(g.kind)) std::visit([&](const auto& keys) { check(keys, g); }, g.kind);
      for (const Obstacle& o : s_.obstacles)
        for (const int a : axes) check(o, std::size_t(a));
    }
  }

 private:
  void check_axes() {
    for (const std::string& axis : s_.domain.periodic) {
      if (flat() && axis == "y")
        add(s_.domain.periodic, "y: with dimensions: 2 nothing moves along y; remove it");
      if (good(s_.domain.open))
        for (const std::string& face : s_.domain.open)
          if (face[0] == axis[0])
            add(s_.domain.open, "{} is joined to the opposite face (domain.periodic); remove one",
                face);
    }
  }

  void check_length(std::size_t a) {
    const double length = s_.domain.max[a] - s_.domain.min[a], least = 3 * s_.h();
    if (length > 0 && length < least * (1 - 1e-9))
      add(s_.domain.periodic,
          "{}: the domain is {} m long along it, and a particle would see images of its own "
          "neighbors; give at least 3 smoothing lengths, {} m, or lower fluid.spacing",
          kAxes[a], rounded(length, 6), rounded(least, 6));
  }

  /// Gravity along a periodic axis drives a flow, which must be held by something.
  void check_forces(std::size_t a) {
    constexpr const char* kFalls =
        "its component along {} is {}, and fluid that returns through a periodic face would fall "
        "for ever; give 0, or remove {} from domain.periodic";
    if (good(s_.gravity) && s_.gravity[a] != 0 && !has_friction(s_))
      add(s_.gravity,
          "its component along {} is {}, and fluid that returns through a periodic face would fall "
          "for ever; give friction to walls or obstacles (domain.friction: 1), or 0 here, or "
          "remove {} from domain.periodic",
          kAxes[a], s_.gravity[a], kAxes[a]);
    if (!s_.settle || !good(s_.settle->gravity, s_.gravity)) return;
    const double g = s_.settle->gravity.value_or(s_.gravity)[a];
    if (g != 0) add(s_.settle->gravity, kFalls, kAxes[a], g, kAxes[a]);
  }

  /// An obstacle has no images. Its fluid is up to kClear away from it
  /// (lib/program/posed_solids.h).
  void check(const Obstacle& o, std::size_t a) {
    if (!good_obstacle(o) || o.free) return;  // check_free() refuses these
    // A plane along the axis is its own image, wherever it moves without turning.
    if (const auto* plane = std::get_if<obstacle_keys::Plane>(&o.shape);
        plane && plane->normal[a] == 0 && (!o.motion || keeps_direction(*o.motion)))
      return;
    if (o.motion)
      return add(o.motion->kind,
                 "{} moves, and obstacles have no images beyond periodic faces; let it stand, make "
                 "it a plane along {} that does not turn, or remove domain.periodic",
                 o.name, kAxes[a]);
    const Solid<double> solid = solid_in_metres(o, s_);
    const Vec3<double> up{double(a == 0), double(a == 1), double(a == 2)};
    const double middle[3] = {solid.center.x, solid.center.y, solid.center.z};
    const double low = middle[a] - reach_along(solid, -1.0 * up, true),
                 high = middle[a] + reach_along(solid, up, true), clear = kClear * s_.h(),
                 from = s_.domain.min[a] + clear, to = s_.domain.max[a] - clear;
    if (low < from - 1e-9 * clear || high > to + 1e-9 * clear)
      add(o.name,
          "reaches {0} = {1}, and obstacles have no images beyond periodic faces: leave 1.5 "
          "smoothing lengths, {0} from {2} to {3}; the flow is the same if all is moved along {0}",
          kAxes[a], rounded(low < from - 1e-9 * clear ? low : high, 6), rounded(from, 6),
          rounded(to, 6));
  }
  bool keeps_direction(const Motion& m) const {
    if (!good(m.kind)) return true;
    if (m.kind == MotionKind::sine || makes_waves(m)) return !m.axis;
    return m.kind == MotionKind::velocity && m.angular == Double3{};
  }
  static constexpr double kClear = 1.5;  ///< h

  void check(const gauge_keys::Flow& g, const Gauge&) {
    add(g.center,
        "flow gauges take a return through a periodic face for flow back; read a velocity gauge, "
        "or remove domain.periodic");
  }
  void check(const gauge_keys::Level& g, const Gauge&) {
    const std::vector<int> across = axes_across_level(s_);
    for (std::size_t k = 0; good(g.at) && k < std::min(across.size(), g.at.size()); ++k)
      check_place(g.at, std::size_t(across[k]), g.at[k], s_.h());
  }
  void check(const gauge_keys::Line& g, const Gauge&) {
    for (const Double3* end : {&g.from, &g.to})
      for (std::size_t a = 0; good(*end) && a < 3; ++a) check_place(*end, a, (*end)[a], s_.h());
  }
  void check(const gauge_keys::Velocity& g, const Gauge&) {
    if (good(g.within)) check_places(g.at, g.within.value_or(s_.h()));
  }
  void check(const gauge_keys::Pressure& g, const Gauge&) {
    if (good(g.radius)) check_places(g.at, g.radius);
  }
  void check_places(const std::vector<double>& at, double reach) {
    for (std::size_t a = 0; good(at) && a < 3 && at.size() == 3; ++a)
      check_place(at, a, at[a], reach);
  }
  /// reach: m, of the gauge, which sees no images.
  void check_place(const auto& at, std::size_t a, double x, double reach) {
    if (!s_.domain.is_periodic(int(a))) return;
    const double low = s_.domain.min[a] + reach, high = s_.domain.max[a] - reach;
    if (x < low - 1e-9 * reach || x > high + 1e-9 * reach)
      add(at,
          "{0} is {1}, and a gauge does not see through a periodic face: give {0} from {2} to {3}; "
          "the flow is the same if all is moved along {0}",
          kAxes[a], x, rounded(low, 6), rounded(high, 6));
  }
};

}  // namespace

void check_periodic(const PlacedScene& placed, Problems& problems) {
  PeriodicChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
