#include "lib/program/settings_row.h"

#include <algorithm>

#include "lib/program/numbers.h"
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

}  // namespace

std::optional<SettingsRow> settings_row(const Scene& s) {
  if (std::ranges::any_of(s.obstacles,
                          [](const Obstacle& o) { return o.motion && makes_waves(*o.motion); }))
    return SettingsRow{"waves", "Travelling and solitary waves", "an obstacle makes waves"};
  if (s.tank_motion) return SettingsRow{"sloshing", "Sloshing", "the tank moves"};
  if (s.settle && s.settle->gravity)
    return SettingsRow{"standing_wave", "Standing wave", "the start settles with a tilted level"};
  if (s.gravity == Double3{} || !s.emitters.empty() || std::ranges::any_of(s.obstacles, is_moved) ||
      std::ranges::any_of(s.bodies, [](const Body& b) { return b.from_file(); }))
    return std::nullopt;
  const FlowSizes sizes = flow_sizes(s);
  if (sizes.fall > s.fluid.spacing)
    return reads_impacts(s)
               ? SettingsRow{"impact_loads", "Impact loads", "fluid falls, and loads are read"}
               : SettingsRow{"dam_break", "Dam break and splash", "fluid falls"};
  if (!(sizes.depth > 0) || sizes.speed > 0) return std::nullopt;
  return sizes.depth >= kDeepLayers * s.fluid.spacing
             ? SettingsRow{"deep_tank", "Deep tank", "the fluid is at rest, 48 layers or more"}
             : SettingsRow{"still_tank", "Still tank", "the fluid is at rest"};
}

}  // namespace pbf::program_module
