// Rules for gauges.
#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/suggest.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::inline scene_module {
namespace {

/// Names of other members of /pbf/gauges: the columns of all, and those of the kinds.
bool is_taken(const std::string& name) {
  bool taken = name == "time" || name == "update";
  for_each_kind<gauge_keys::Any>([&](const auto& kind) {
    for (const GaugeColumn& c : kind.columns) taken |= *c.name && name == c.name;
  });
  return taken;
}

/// The interface for the checks of a kind.
class GaugeRules : public SceneRules {
 public:
  using SceneRules::add, SceneRules::flat, SceneRules::good;
  using SceneRules::SceneRules;

  const Scene& scene() const { return s_; }
  static std::string axis(int a) { return kAxes[a]; }
  static std::string count(const std::vector<double>& at) {
    return std::to_string(at.size()) + (at.size() == 1 ? " number" : " numbers");
  }
  bool is_place(const std::vector<double>& at) {
    if (at.size() == 3) return true;
    add(at, "has " + count(at) + ", expected a place, [x, y, z]" +
                (flat() ? " (y does not count with dimensions: 2)" : ""));
    return false;
  }
  /// Whether a place, given by the member, is in the domain.
  bool inside(const auto& member, const Double3& at) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (flat() && k == 1) continue;
      const double min = s_.domain.min[k], max = s_.domain.max[k], slack = 1e-9 * (max - min);
      if (at[k] >= min - slack && at[k] <= max + slack) continue;
      add(member, std::string(kAxes[k]) + " is " + to_text(at[k]) + ", outside the domain (" +
                      kAxes[k] + " from " + to_text(min) + " to " + to_text(max) +
                      " m); move the gauge");
      return false;
    }
    return true;
  }
  /// A disc at a place of a surface that stands still and that fluid comes to.
  void check_disc(const std::vector<double>& at, const std::string& on, const double& radius) {
    const bool sizes = good(s_.fluid.spacing);
    if (good(radius) && sizes && radius < 2 * s_.fluid.spacing * (1 - 1e-9))
      add(radius, "is " + to_text(radius) + ", below 2 fluid.spacing (" +
                      to_text(2 * s_.fluid.spacing) +
                      " m): so few particles have no mean; enlarge it or lower fluid.spacing to " +
                      to_text(radius / 2));
    if (!good(on, s_.obstacles, s_.domain.open)) return;
    const std::optional<int> surface = surface_named(s_, on);
    if (!surface) return add(on, unknown_surface(on));
    const Obstacle* o = obstacle_of(s_, *surface);
    if (!o) {
      if (flat() && *surface / 2 == 1)
        return add(on, on + " is no wall with dimensions: 2; give another");
      if (s_.domain.is_open(*surface / 2, *surface % 2 == 1))
        return add(on, on + " is open, without a wall (domain.open); give another");
    } else if (!good_obstacle(*o)) {
      return;
    } else if (o->motion) {
      return add(on, on + " moves, and a pressure gauge stays where it is; give it loads "
                          "instead (obstacles[].loads), or put the gauge on what stands");
    }
    if (!good(at) || !is_place(at) || !inside(at, place(at)) || !sizes) return;
    const SurfacePlace there = nearest_place_on(*surface, s_, place(at));
    const double d = s_.fluid.spacing;
    if (!(std::fabs(there.distance) <= 0.1 * d))
      return add(at, "is " + to_text(rounded(std::fabs(there.distance))) +
                         " m from the surface of " + on +
                         "; a pressure gauge lies on it (nearest point " + text(there.point) + ")");
    if (!is_free(s_, there.point + (0.25 * d) * there.normal))
      return add(at, "no fluid comes to this place of " + on +
                         ": another obstacle or the end of the domain is before it; move it");
    if (!o || !good(radius)) return;
    const double round = round_side(*o, s_, there.point).radius;
    if (round > 0 && radius > round - d)
      add(radius, "is " + to_text(radius) + ", more than the radius of " + on +
                      " less fluid.spacing (" + to_text(round - d) + " m); lower it");
  }

 private:
  bool good_obstacle(const Obstacle& o) const {
    return good(o.shape) &&
           std::visit(
               [&]<class Shape>(const Shape& keys) {
                 const Matrix3 axes = keys.axes();  // NaN if a direction has length 0
                 return std::isfinite(axes[0][0]) &&
                        std::apply([&](const auto&... key) { return good(keys.*key.member...); },
                                   Shape::keys());
               },
               o.shape);
  }

  std::string unknown_surface(const std::string& on) const {
    std::vector<std::string> names(kFaceNames.begin(), kFaceNames.end());
    for (const Obstacle& o : s_.obstacles) names.push_back(o.name);
    const std::string near = nearest_choice(on, names);
    return "no obstacle is named " + on + ", and no wall of the domain" +
           (near.empty() ? "; there are " : "; did you mean " + near + "? There are ") +
           joined(names, ", ");
  }

  static Double3 place(const std::vector<double>& at) { return {at[0], at[1], at[2]}; }
  static double rounded(double x) { return std::stod(format("%.4g", x)); }
  static std::string text(const Double3& p) {
    return format("(%.6g, %.6g, %.6g)", p[0], p[1], p[2]);
  }
};

class GaugeChecker : public GaugeRules {
 public:
  using GaugeRules::GaugeRules;

  void run() {
    if (!good(s_.gauges)) return;
    std::map<std::string, std::size_t> seen;
    std::map<std::size_t, int> number;  // of each kind
    for (std::size_t k = 0; k < s_.gauges.size(); ++k) {
      const Gauge& g = s_.gauges[k];
      if (good(g.name)) check_name(g.name, k, seen);
      if (!good(g.kind)) continue;
      const int of_kind = ++number[g.kind.index()];
      std::visit([&](const auto& keys) { check(g, keys, of_kind); }, g.kind);
    }
  }

 private:
  void check_name(const std::string& is, std::size_t k, std::map<std::string, std::size_t>& seen) {
    const std::string& at = s_.gauges[k].name;
    if (is.find('/') != std::string::npos || is == "." || is == "..")
      add(at, "\"" + is + "\" cannot name data of the run file; give a word without \"/\"");
    else if (is_taken(is))
      add(at, "is a name that /pbf/gauges has already; choose another");
    else if (const auto [first, fresh] = seen.try_emplace(is, k); !fresh)
      add(at, "is also the name of gauges[" + std::to_string(first->second) + "]; choose another");
  }
  template <class Kind>
  void check(const Gauge& g, const Kind& keys, int of_kind) {
    if constexpr (requires { Kind::most; })
      if (of_kind > Kind::most)
        add(g.kind, format("is %s gauge %d, at most %d are possible; remove some", Kind::word,
                           of_kind, Kind::most));
    if (good(s_.dimensions, s_.domain.min, s_.domain.max, s_.gravity))
      keys.check(static_cast<GaugeRules&>(*this));
  }
};

}  // namespace

void check_gauges(const PlacedScene& placed, Problems& problems) {
  GaugeChecker(placed, problems).run();
}

}  // namespace pbf::inline scene_module
