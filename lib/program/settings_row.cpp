#include "lib/program/settings_row.h"

#include <algorithm>
#include <cmath>

#include "lib/scene/body_box.h"
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

/// Heights against gravity above the lowest place of the domain, m.
struct StartLevel {
  double top = 0, bottom = 0;
  bool rests = true;  ///< all that is free below the top is fluid
};

/// Of a scene whose bodies are blocks, from a grid of places.
StartLevel start_level(const Scene& s) {
  constexpr int kAcross = 24, kUp = 120;
  const auto up = std::size_t(level_axis(s));
  const std::vector<int> across = axes_across_level(s);
  const double height = s.domain.max[up] - s.domain.min[up], dz = height / kUp;
  const bool turned = s.gravity[up] > 0;
  enum { solid, dry, wet };
  std::vector<std::array<char, kUp>> columns;
  const auto state = [&](const Double3& x) {
    if (!is_free(s, x)) return solid;
    return std::ranges::any_of(
               s.bodies,
               [&](const Body& b) {
                 const BodyBox box = body_box(b);
                 for (std::size_t a = 0; a < 3; ++a)
                   if (!(s.dimensions == 2 && a == 1) && (x[a] < box.low[a] || x[a] > box.high[a]))
                     return false;
                 return true;
               })
               ? wet
               : dry;
  };
  const int rows = across.size() > 1 ? kAcross : 1;
  StartLevel level{0, height, true};
  for (const Body& b : s.bodies) {
    const BodyBox box = body_box(b);
    const double ends[] = {
        turned ? s.domain.max[up] - box.high[up] : box.low[up] - s.domain.min[up],
        turned ? s.domain.max[up] - box.low[up] : box.high[up] - s.domain.min[up]};
    level.bottom = std::min(level.bottom, ends[0]), level.top = std::max(level.top, ends[1]);
  }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < kAcross; ++i) {
      Double3 x = s.domain.min;
      const auto place = [&](std::size_t k, double share) {
        const auto a = std::size_t(across[k]);
        x[a] = s.domain.min[a] + share * (s.domain.max[a] - s.domain.min[a]);
      };
      place(0, (i + 0.5) / kAcross);
      if (rows > 1) place(1, (j + 0.5) / kAcross);
      std::array<char, kUp>& column = columns.emplace_back();
      for (int k = 0; k < kUp; ++k) {
        const double z = (k + 0.5) * dz;
        x[up] = turned ? s.domain.max[up] - z : s.domain.min[up] + z;
        column[std::size_t(k)] = char(state(x));
      }
    }
  // Blocks end where whole spacings do.
  const double surface = level.top - 1.01 * s.fluid.spacing - dz;
  for (const auto& column : columns)
    for (int k = 0; (k + 0.5) * dz < surface && k < kUp; ++k)
      if (column[std::size_t(k)] == dry) level.rests = false;
  return level;
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
  const StartLevel level = blocks ? start_level(s) : StartLevel{0, 0, false};
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
