// Rules for gauges.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/suggest.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {
namespace {

/// Names of other members of /pbf/gauges: the columns of all, and those of the kinds.
std::vector<std::string> taken_names() {
  std::vector<std::string> taken{"time", "update"};
  for_each_kind<gauge_keys::Any>([&](const auto& kind) {
    for (const GaugeColumn& c : kind.columns)
      if (*c.name) taken.push_back(c.name);
  });
  return taken;
}

constexpr int kMostFlows = 32;  // bits of a side (kernels/pass_flow.h)

class GaugeChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    if (!good(s_.gauges)) return;
    check_names(s_.gauges, "gauges", "data of the run file", taken_names(),
                "a name that /pbf/gauges has already");
    int flows = 0;
    for (const Gauge& g : s_.gauges) {
      if (!good(g.kind)) continue;
      if (std::get_if<gauge_keys::Flow>(&g.kind) && ++flows > kMostFlows)
        add(g.kind, "is the 33rd flow gauge, at most 32 are possible; remove some");
      if (good(s_.dimensions, s_.domain.min, s_.domain.max, s_.gravity))
        std::visit([&](const auto& keys) { check(keys); }, g.kind);
    }
  }

 private:
  void check(const gauge_keys::Level& g) {
    if (!good(g.at)) return;
    const std::vector<int> across = axes_across_level(s_);
    std::string wanted;
    for (const int a : across) wanted += (wanted.empty() ? "[" : ", ") + std::string(kAxes[a]);
    if (g.at.size() != across.size())
      return add(g.at, "has {}, and a level is read along {}, the axis of gravity{}; give {}]",
                 count(g.at), kAxes[level_axis(s_)], flat() ? ", with dimensions: 2" : "", wanted);
    Double3 at = s_.domain.min;
    for (std::size_t k = 0; k < across.size(); ++k) at[std::size_t(across[k])] = g.at[k];
    inside(g.at, at);
  }

  void check(const gauge_keys::Line& g) {
    if (!good(g.from, g.to) || !inside(g.from, g.from) || !inside(g.to, g.to)) return;
    Double3 way = g.to - g.from;
    if (flat()) way[1] = 0;
    if (good(s_.fluid.spacing) && !(length(way) >= s_.fluid.spacing * (1 - 1e-9)))
      add(g.to, "is {} m from `from`, less than fluid.spacing ({} m); move one of them away",
          rounded(length(way)), s_.fluid.spacing);
  }

  void check(const gauge_keys::Velocity& g) {
    if (good(g.at) && is_place(g.at)) inside(g.at, place(g.at));
    if (good(g.within, s_.fluid.spacing) && g.within && *g.within < s_.fluid.spacing * (1 - 1e-9))
      add(g.within, "is {}, below fluid.spacing ({} m), where often no particle is; enlarge it",
          *g.within, s_.fluid.spacing);
  }

  void check(const gauge_keys::Flow& g) {
    if (good(g.normal) && dot(g.normal, g.normal) == 0)
      add(g.normal, "has no direction; give the way that counts as positive, [1, 0, 0] say");
    else if (good(g.normal) && flat() && g.normal[1] != 0)
      add(g.normal, "has a y component, with dimensions: 2 nothing flows along y; give 0 for y");
    const std::size_t edges = flat() ? 1 : 2;
    if (good(g.size) && g.size.size() != edges)
      add(g.size, "has {}, expected {}", count(g.size),
          flat() ? "one, the length of a line in the x-z plane (dimensions: 2)"
                 : "two, the edges of a rectangle");
    if (good(g.center)) inside(g.center, g.center);
  }

  void check(const gauge_keys::Pressure& g) {
    const bool sizes = good(s_.fluid.spacing);
    if (good(g.radius) && sizes && g.radius < 2 * s_.fluid.spacing * (1 - 1e-9))
      add(g.radius,
          "is {}, below 2 fluid.spacing ({} m): so few particles have no mean; enlarge it or lower "
          "fluid.spacing to {}",
          g.radius, 2 * s_.fluid.spacing, g.radius / 2);
    if (!good(g.on, s_.obstacles, s_.domain.open)) return;
    const std::optional<int> surface = surface_named(s_, g.on);
    if (!surface) return add(g.on, "{}", unknown_surface(g.on));
    const Obstacle* o = obstacle_of(s_, *surface);
    if (!o) {
      if (flat() && *surface / 2 == 1)
        return add(g.on, "{} is no wall with dimensions: 2; give another", g.on);
      if (s_.domain.is_open(*surface / 2, *surface % 2 == 1))
        return add(g.on, "{} is open, without a wall (domain.open); give another", g.on);
    } else if (!good_obstacle(*o)) {
      return;
    } else if (o->moves()) {
      return add(g.on,
                 "{} moves, and a pressure gauge stays where it is; give it loads instead "
                 "(obstacles[].loads), or put the gauge on what stands",
                 g.on);
    }
    if (o && o->surface_file())
      return add(g.on,
                 "the surface of {} comes from a file, which has no flat faces for a gauge; give "
                 "it loads instead (obstacles[].loads)",
                 g.on);
    if (!good(g.at) || !is_place(g.at) || !inside(g.at, place(g.at)) || !sizes) return;
    const SurfacePlace there = nearest_place_on(*surface, s_, place(g.at));
    const double d = s_.fluid.spacing;
    if (!(std::fabs(there.distance) <= 0.1 * d))
      return add(g.at,
                 "is {} m from the surface of {}; a pressure gauge lies on it (nearest point {})",
                 rounded(std::fabs(there.distance)), g.on, text(there.point));
    if (!is_free(s_, there.point + (0.25 * d) * there.normal))
      return add(g.at,
                 "no fluid comes to this place of {}: another obstacle or the end of the domain is "
                 "before it; move it",
                 g.on);
    if (!o || !good(g.radius)) return;
    const double radius = round_side(*o, s_, there.point).radius;
    if (radius > 0 && g.radius > radius - d)
      add(g.radius, "is {}, more than the radius of {} less fluid.spacing ({} m); lower it",
          g.radius, g.on, radius - d);
  }

  std::string unknown_surface(const std::string& on) const {
    std::vector<std::string> names(kFaceNames.begin(), kFaceNames.end());
    for (const Obstacle& o : s_.obstacles) names.push_back(o.name);
    const std::string near = nearest_choice(on, names);
    return "no obstacle is named " + on + ", and no wall of the domain" +
           (near.empty() ? "; there are " : "; did you mean " + near + "? There are ") +
           joined(names, ", ");
  }

  bool is_place(const std::vector<double>& at) {
    if (at.size() == 3) return true;
    add(at, "has {}, expected a place, [x, y, z]{}", count(at),
        flat() ? " (y does not count with dimensions: 2)" : "");
    return false;
  }
  static Double3 place(const std::vector<double>& at) { return {at[0], at[1], at[2]}; }
  static std::string count(const std::vector<double>& at) {
    return std::to_string(at.size()) + (at.size() == 1 ? " number" : " numbers");
  }
  static std::string text(const Double3& p) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]);
  }

  bool inside(const auto& member, const Double3& at) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (flat() && k == 1) continue;
      const double min = s_.domain.min[k], max = s_.domain.max[k], slack = 1e-9 * (max - min);
      if (at[k] >= min - slack && at[k] <= max + slack) continue;
      add(member, "{0} is {1}, outside the domain ({0} from {2} to {3} m); move the gauge",
          kAxes[k], at[k], min, max);
      return false;
    }
    return true;
  }
};

}  // namespace

void check_gauges(const PlacedScene& placed, Problems& problems) {
  GaugeChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
