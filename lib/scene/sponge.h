// Sponges as plain data: zones in which velocities decay. kernels/pass_sponge.h applies them.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// The index of a face in kFaceNames; that of x_min for other words, which the table refuses.
inline int face_named(const std::string& name) {
  const auto at = std::find(kFaceNames.begin(), kFaceNames.end(), name);
  return at == kFaceNames.end() ? 0 : int(at - kFaceNames.begin());
}

/// Whether velocities along an axis of the scene decay.
inline bool damps(const Sponge& sponge, int axis) {
  return std::find(sponge.axes.begin(), sponge.axes.end(), std::string(1, "xyz"[axis])) !=
         sponge.axes.end();
}

/// s, of the first obstacle whose motion has one: that of an oscillation, or of the waves that it
/// makes.
inline std::optional<double> wave_period(const Scene& s) {
  for (const Obstacle& o : s.obstacles)
    if (o.motion && (o.motion->kind == MotionKind::sine || makes_waves(*o.motion)) &&
        o.motion->kind != MotionKind::solitary_waves)
      return o.motion->period;
  return std::nullopt;
}

/// Rates per period with which a zone of one wavelength reflects least (linear long waves).
inline constexpr double kSpongeRate = 15;
/// 1/s, where the zone damps most.
inline double sponge_rate(const Scene& s, const Sponge& sponge) {
  return sponge.rate.value_or(kSpongeRate / wave_period(s).value_or(1));
}

}  // namespace pbf::scene_module
