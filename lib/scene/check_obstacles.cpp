// Rules for obstacles.
#include <fmt/core.h>
#include <algorithm>

#include "lib/scene/rounding.h"
#include "lib/scene/scene_rules.h"

namespace pbf::scene_module {
namespace {

/// The interface for the checks of a shape.
class ShapeRules : public SceneRules {
 public:
  using SceneRules::above, SceneRules::add, SceneRules::flat, SceneRules::good, SceneRules::name;
  using SceneRules::SceneRules;

  double h() const { return s_.h(); }
  bool paper() const { return good(s_.solver.kernels) && s_.solver.kernels == KernelMode::paper; }
  double smoothing_ratio() const { return s_.fluid.smoothing_ratio; }
  /// Whether h and the member were read without a problem.
  bool good_h(const double& member) const {
    return good(member, s_.fluid.spacing, s_.fluid.smoothing_ratio);
  }
  /// Refuses a solid so thin that rounding could put particles on its other side.
  void check_thickness(const Double3& end, double thick) {
    if (!good(s_.domain.min, s_.domain.max, s_.dimensions, s_.precision, s_.fluid.spacing,
              s_.fluid.smoothing_ratio))
      return;
    for (std::size_t a = 0; a < 3; ++a)
      if (!(s_.domain.max[a] > s_.domain.min[a])) return;
    const double apart = position_spacing(s_) * s_.h(), least = kThinnestSolid * apart;
    if (thick >= least) return;
    const bool single = s_.precision == Precision::single;
    add(end, "{}",
        fmt::format("makes a plate {:.3g} m thick, and positions in {} are {:.3g} m apart at the "
                    "far end of the domain: fluid would pass through it; give at least {:.2g} m{}",
                    thick, word(s_.precision), apart, 1.05 * least,
                    single ? ", or precision: double" : ""));
  }
};

class ObstacleChecker : public ShapeRules {
 public:
  using ShapeRules::ShapeRules;

  void run() {
    check_names(s_.obstacles, "obstacles", "columns of the log", kFaceNames,
                "the name of a wall of the domain");
    for (const Obstacle& o : s_.obstacles)
      if (good(o.shape))
        std::visit([&](const auto& keys) { keys.check(static_cast<ShapeRules&>(*this)); }, o.shape);
    for (const Obstacle& o : s_.obstacles)
      if (o.motion && std::holds_alternative<obstacle_keys::Heights>(o.shape))
        add(o.motion->kind, "a bed of heights stands still; give a mesh to what moves");
  }
};

}  // namespace

void check_obstacles(const PlacedScene& placed, Problems& problems) {
  ObstacleChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
