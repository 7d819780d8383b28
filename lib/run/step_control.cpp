#include "lib/run/step_control.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/program/motion.h"
#include "lib/scene/nozzle.h"

namespace pbf::run_module {
namespace {

constexpr std::int64_t kEarly = 8, kLongestHold = std::int64_t(1) << 30;  // scheduled measurements

}  // namespace

AdaptiveStep::AdaptiveStep(const Scene& scene, const StepHistory& before)
    : scene_(scene), finest_(finest_level(scene)), h_(before) {
  h_.updates.resize(std::size_t(finest_) + 1);
  h_.level = std::clamp<std::int64_t>(h_.level, 0, finest_);
}

double AdaptiveStep::step(int level) const { return std::ldexp(scene_.time.step, -level); }

std::optional<std::string> AdaptiveStep::follow(const Diagnostics& m) {
  // Prescribed motions are known up to the next choice, those of free bodies now.
  place_bodies(scene_, m.bodies);
  const double next = m.time + scene_.measure_every * scene_.time.step;
  double acceleration = greatest_pull(scene_, m.time, next);
  const double speed = std::max(
      {m.speed_max, fastest_obstacle(scene_, m.time, next), fastest_emitter(scene_, m.time, next)});
  if (h_.speed >= 0 && m.time > h_.time)
    acceleration = std::max(acceleration, std::fabs(m.speed_max - h_.speed) / (m.time - h_.time));
  h_.time = m.time;
  h_.speed = m.speed_max;
  if (h_.hold > 0) --h_.hold;
  if (h_.coarse >= 0) ++h_.coarse;
  const double before = step(level());
  double longest = longest_step(scene_, speed, acceleration);
  // Neighbors moved too far past each other: halve the step, repeatedly if needed.
  const bool unresolved = m.unresolved > h_.unresolved;
  if (unresolved) longest = std::min(longest, before / 2);
  h_.unresolved = m.unresolved;
  const int to = next_level(scene_, level(), longest, h_.hold == 0);
  if (step(to) > longest) ++h_.floor;
  if (to == level()) return std::nullopt;
  const double h = scene_.h();
  return fmt::format("update {}, {:.6g} s: ", m.update, m.time) + change(to, m.update, false) +
         fmt::format(": v_max dt {:.3g} h, dt sqrt(a/h) {:.3g} before", speed * before / h,
                     before * std::sqrt(acceleration / h)) +
         (unresolved ? "; neighbors moved too far past each other" : "");
}

std::optional<std::string> AdaptiveStep::refine(const std::string& alarm, const Diagnostics& m,
                                                std::int64_t back) {
  if (level() == finest_) return std::nullopt;
  ++h_.repeats;
  return fmt::format("update {}, {:.6g} s: alarm of the guard ({}), back to update {}: ", m.update,
                     m.time, alarm, back) +
         change(level() + 1, back, true);
}

std::string AdaptiveStep::change(int to, std::int64_t update, bool alarm) {
  const double before = step(level());
  if (to < level()) {
    h_.coarse = 0;
  } else {
    const bool early = h_.coarse >= 0 && h_.coarse <= kEarly;
    if (early) h_.hold_length = std::min(2 * h_.hold_length, kLongestHold);
    if (early || alarm) h_.hold = h_.hold_length;
    h_.coarse = -1;
  }
  h_.updates = updates_at_levels(update);
  h_.since = update;
  h_.level = to;
  ++h_.changes;
  return fmt::format("step {:.6g} s (was {:.6g})", step(to), before);
}

std::vector<std::int64_t> AdaptiveStep::updates_at_levels(std::int64_t update) const {
  std::vector<std::int64_t> all = h_.updates;
  all[std::size_t(h_.level)] += update - h_.since;
  return all;
}

}  // namespace pbf::run_module
