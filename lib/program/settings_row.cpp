#include "lib/program/settings_row.h"

#include <algorithm>
#include <cmath>

#include "lib/program/start_level.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"
#include "lib/scene/waves.h"

namespace pbf::program_module {
namespace {

constexpr double kDeepLayers = 48;  // from here on levels pay off in fluid at rest

bool is_moved(const Obstacle& o) { return o.motion || o.free; }

/// Whether a load or a pressure on something that stands is read.
bool reads_impacts(const Scene& s) {
  return s.domain.loads ||
         std::ranges::any_of(s.obstacles,
                             [](const Obstacle& o) { return o.loads && !is_moved(o); }) ||
         std::ranges::any_of(s.gauges, [](const Gauge& g) {
           return std::holds_alternative<gauge_keys::Pressure>(g.kind);
         });
}

std::optional<SettingsRow> row_of_fluid(const Scene& s) {
  const auto moves = [](const Body& b) { return dot(b.velocity, b.velocity) > 0; };
  const auto special = [](const Body& b) { return b.from_file(); };
  const auto from_file = [](const Obstacle& o) { return o.surface_file() != nullptr; };
  if (s.bodies.empty() || std::ranges::any_of(s.bodies, special) ||
      std::ranges::any_of(s.obstacles, from_file))
    return std::nullopt;
  const auto is_block = [](const Body& b) {
    return b.shape == Shape::block || b.shape == Shape::random_box;
  };
  const bool blocks = std::ranges::all_of(s.bodies, is_block);
  const StartLevel level = blocks ? start_level(s) : StartLevel{.rests = false};
  if (!level.rests)
    return reads_impacts(s)
               ? SettingsRow{"impact_loads", "Impact loads", "fluid falls, and loads are read"}
               : SettingsRow{"dam_break", "Dam break and splash", "fluid falls"};
  if (std::ranges::any_of(s.bodies, moves)) return std::nullopt;
  return level.top - level.bottom >= (kDeepLayers - 0.5) * s.fluid.spacing
             ? SettingsRow{"deep_tank", "Deep tank", "the fluid is at rest, 48 layers or more"}
             : SettingsRow{"still_tank", "Still tank", "the fluid is at rest"};
}

}  // namespace

std::optional<SettingsRow> settings_row(const Scene& s) {
  if (std::ranges::any_of(s.obstacles,
                          [](const Obstacle& o) { return o.motion && makes_waves(*o.motion); }))
    return SettingsRow{"waves", "Travelling and solitary waves", "an obstacle makes waves"};
  if (s.tank_motion) return SettingsRow{"sloshing", "Sloshing", "the tank moves"};
  const double g = length(s.gravity);
  if (s.settle && s.settle->gravity &&
      length(cross(*s.settle->gravity, s.gravity)) > 1e-6 * g * length(*s.settle->gravity))
    return SettingsRow{"standing_wave", "Standing wave", "the start settles with a tilted level"};
  if (!(std::fabs(s.gravity[std::size_t(level_axis(s))]) > 0.999 * g && g > 0) ||
      !s.emitters.empty() || std::ranges::any_of(s.obstacles, is_moved))
    return std::nullopt;
  return row_of_fluid(s);
}

}  // namespace pbf::program_module
