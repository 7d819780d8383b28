// Rules for prescribed motions.
#include "lib/scene/scene_rules.h"

namespace pbf::scene_module {
namespace {

class MotionChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    for (const Obstacle& o : s_.obstacles) {
      if (!o.motion || !good(o.motion->kind)) continue;
      const Motion& m = *o.motion;
      if (m.kind == MotionKind::sine) check_swing(m, m.kind, true);
      if (m.kind == MotionKind::velocity) {
        must_lie_flat(m.velocity, m.velocity);
        if (good(m.angular) && flat() && (m.angular[0] != 0 || m.angular[2] != 0))
          add(m.angular, kAboutY);
      }
      if (m.kind == MotionKind::file) check_path(m.path);
    }
    if (!s_.tank_motion || !good(s_.tank_motion->kind)) return;
    const TankMotion& m = *s_.tank_motion;
    check_swing(m, m.kind, m.kind == TankMotionKind::sine);
    if (m.kind == TankMotionKind::file) check_path(m.path);
  }

 private:
  static constexpr const char* kAboutY =
      "with dimensions: 2 nothing turns but about y; give [0, 1, 0] times a number";

  void check_path(const std::string& path) {
    if (good(path) && path.empty()) add(path, "names no file; give that of a CSV table");
  }
  /// `swings`: requires a direction or an axis; otherwise an axis is optional.
  void check_swing(const Swing& m, const auto& kind, bool swings) {
    if (!good(m.axis) || (swings && !good(m.direction))) return;
    if (swings && bool(m.direction) == bool(m.axis)) {
      add_at(block_of(name(kind)), "a sine needs {}",
             m.axis ? "direction or axis, not both; remove one"
                    : "direction (amplitude in m) or axis (degrees); give one");
      return;
    }
    const std::optional<Double3>& along = swings && m.direction ? m.direction : m.axis;
    if (along && (*along)[0] == 0 && (*along)[1] == 0 && (*along)[2] == 0)
      add(along, "has no direction; give one, [0, 1, 0] say");
    if (swings && m.direction) must_lie_flat(m.direction, *m.direction);
    if (m.axis && flat() && ((*m.axis)[0] != 0 || (*m.axis)[2] != 0)) add(m.axis, kAboutY);
    if (m.pivot && good(m.pivot) && !m.axis)
      add(m.pivot, "is the point about which something turns, and there is no axis; remove it");
  }
};

}  // namespace

void check_motions(const PlacedScene& placed, Problems& problems) {
  MotionChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
