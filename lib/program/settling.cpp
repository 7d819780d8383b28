#include "lib/program/settling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/program/motion.h"
#include "lib/program/schedule.h"
#include "lib/program/time_levels.h"
#include "lib/scene/vector3.h"

namespace pbf::program_module {
namespace {

/// Gravity in the frame of the tank when the run begins.
Double3 gravity_at_begin(const Scene& s) {
  if (!s.tank_motion || !s.tank_motion->axis) return s.gravity;
  return turned(s.gravity, unit(*s.tank_motion->axis), -tank_pose(s, 0).angle);
}

}  // namespace

Scene settling_scene(const Scene& scene) {
  const Double3 g = scene.settle->gravity.value_or(gravity_at_begin(scene));
  const int level =
      scene.time.adaptive ? next_level(scene, 0, longest_step(scene, 0, length(g)), false) : 0;
  Scene s = scene_at_level(scene, level);
  s.gravity = g;
  s.time.end = std::max(scene.settle->duration, s.time.step);
  s.time.adaptive.reset();
  s.solver.velocity_damping *= std::exp(-kSettlingDamping * s.time.step / s.time.end);
  s.tank_motion.reset();
  for (Obstacle& o : s.obstacles) {
    o.loads = false;
    if (o.motion) o.motion->waits = true;
    o.free.reset();  // it is held
  }
  s.domain.loads = false;
  s.gauges.clear();
  // What is in the pipes stays there.
  for (Emitter& e : s.emitters) e.start = std::numeric_limits<double>::infinity();
  s.sinks.clear();
  s.capacity = 0;
  s.settle.reset();
  s.guard.reset();
  s.output.reset();
  s.checkpoint.reset();
  s.render.reset();
  return s;
}

std::int64_t settling_updates(const Scene& scene) {
  return scene.settle ? make_schedule(settling_scene(scene)).updates : 0;
}

}  // namespace pbf::program_module
