// What holds of obstacles.
#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/scene/rounding.h"
#include "lib/scene/scene_rules.h"

namespace pbf::inline scene_module {
namespace {

class ObstacleChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    std::map<std::string, std::size_t> seen;
    for (std::size_t k = 0; k < s_.obstacles.size(); ++k) {
      const Obstacle& o = s_.obstacles[k];
      if (good(o.name)) {
        if (o.name.empty() || o.name.find('/') != std::string::npos || o.name == "." ||
            o.name == "..")
          add(o.name,
              "\"" + o.name + "\" cannot name columns of the log; give a word without \"/\"");
        else if (is_face(o.name))
          add(o.name, "is the name of a wall of the domain; choose another");
        else if (const auto [first, fresh] = seen.try_emplace(o.name, k); !fresh)
          add(o.name, "is also the name of obstacles[" + std::to_string(first->second) +
                          "]; choose another");
      }
      if (good(o.shape)) check_obstacle(o);
    }
  }

 private:
  static bool is_face(const std::string& name) {
    return std::find(kFaceNames.begin(), kFaceNames.end(), name) != kFaceNames.end();
  }
  /// Rounding puts particles on the other side of what is thinner.
  void check_thickness(const Double3& end, double thick) {
    if (!good(s_.domain.min, s_.domain.max, s_.dimensions, s_.precision, s_.fluid.spacing,
              s_.fluid.smoothing_ratio))
      return;
    for (std::size_t a = 0; a < 3; ++a)
      if (!(s_.domain.max[a] > s_.domain.min[a])) return;
    const double apart = position_spacing(s_) * s_.h(), least = kThinnestSolid * apart;
    if (thick >= least) return;
    const bool single = s_.precision == Precision::single;
    add(end, "makes a plate " + format("%.3g", thick) + " m thick, and positions in " +
                 word(s_.precision) + " are " + format("%.3g", apart) +
                 " m apart at the far end of the domain: fluid would pass through it; give at "
                 "least " +
                 format("%.2g", 1.05 * least) + " m" + (single ? ", or precision: double" : ""));
  }
  void check_obstacle(const Obstacle& o) {
    const auto squared = [](const Double3& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
    const bool tube = o.shape == ObstacleShape::cylinder || o.shape == ObstacleShape::capsule;
    switch (o.shape) {
      case ObstacleShape::plane:
        if (good(o.normal) && squared(o.normal) == 0)
          add(o.normal, "has no direction; give one away from the solid, [0, 0, 1] say");
        else if (good(o.normal) && flat() && o.normal[1] != 0)
          add(o.normal,
              "has a y component, with dimensions: 2 planes stand on the x-z plane; give "
              "0 for y");
        break;
      case ObstacleShape::box:
        if (good(o.min, o.max) && above(o.min, o.max)) {
          const Double3 edge{o.max[0] - o.min[0], o.max[1] - o.min[1], o.max[2] - o.min[2]};
          check_thickness(
              o.max, flat() ? std::min(edge[0], edge[2]) : std::min({edge[0], edge[1], edge[2]}));
        }
        if (good(o.turn_axis) && squared(o.turn_axis) == 0)
          add(o.turn_axis, "has no direction; give one, [0, 1, 0] say");
        else if (good(o.turn_axis, o.turn_angle) && flat() && o.turn_angle != 0 &&
                 (o.turn_axis[0] != 0 || o.turn_axis[2] != 0))
          add(o.turn_axis, "with dimensions: 2 a box can only be turned about y; give [0, 1, 0]");
        break;
      case ObstacleShape::cylinder:
        if (good(o.from, o.to) && o.from != o.to && !flat())
          check_thickness(
              o.to, std::hypot(o.to[0] - o.from[0], o.to[1] - o.from[1], o.to[2] - o.from[2]));
        break;
      case ObstacleShape::capsule:
      case ObstacleShape::sphere:
        break;
    }
    if (!tube && !(o.shape == ObstacleShape::sphere && flat())) return;
    if (tube && good(o.from, o.to)) {
      if (o.from == o.to)
        add(o.to, "is where the axis begins (" + name(o.from) + "); give the other end");
      else if (flat() && o.shape == ObstacleShape::capsule && o.from[1] != o.to[1])
        add(o.to, "with dimensions: 2 a capsule lies in the x-z plane; give both ends the same y");
      else if (flat() && o.shape == ObstacleShape::cylinder &&
               (o.from[0] != o.to[0] || o.from[2] != o.to[2]))
        add(o.to,
            "with dimensions: 2 a cylinder stands on the x-z plane, which makes a disc of it; give "
            "both ends the same x and z, or a box");
    }
    if (good(o.radius, s_.fluid.spacing, s_.fluid.smoothing_ratio) && o.radius < s_.h())
      add(o.radius, "is " + to_text(o.radius) + ", below the smoothing length (" + to_text(s_.h()) +
                        " m): the fluid could not see how the surface is "
                        "curved; enlarge it or lower fluid.spacing to " +
                        to_text(o.radius / s_.fluid.smoothing_ratio));
  }
};

}  // namespace

void check_obstacles(const PlacedScene& placed, Problems& problems) {
  ObstacleChecker(placed, problems).run();
}

}  // namespace pbf::inline scene_module
