#include "lib/render/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "lib/render/start_volume.h"
#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

constexpr double kUneven = 1.6;      // speeds over that of energy spread evenly
constexpr double kPast = 1.25;       // of flow past a solid, over the solid's
constexpr double kArriving = 0.8;    // of what falls, over the speed at which it arrives
constexpr double kThrown = 2;        // of what an obstacle throws up, over the obstacle's
constexpr double kSplash = 12;       // heights, over that of energy spread evenly
constexpr double kJet = 1.6;         // of a crater's jet, over the fall that made it
constexpr double kCalm = 0.05;       // spacings that the particles of a calm pool fall
constexpr double kBodyShare = 0.01;  // of the fluid, from which on a body counts by itself

/// Whether fluid at rest would leave: through the floor or a side.
bool leaks(const Scene& scene, const Double3& up) {
  for (int k = 0; k < 3; ++k)
    for (const bool high : {false, true})
      if (scene.domain.is_open(k, high) && (high ? 1 : -1) * up[static_cast<std::size_t>(k)] < 0.5)
        return true;
  return false;
}

/// m along `up`, of the highest place of a solid; of a plane nothing.
double top_of(const Solid<double>& s, const Double3& up) {
  const Vec3<double> way{up[0], up[1], up[2]};
  return is_bounded(s) ? dot(s.center, way) + reach_along(s, way, false)
                       : -std::numeric_limits<double>::infinity();
}

/// m along `up`, of the highest place of any obstacle between start and end.
double top_of_solids(const Scene& scene, const Double3& up) {
  double top = -std::numeric_limits<double>::infinity();
  const int times = has_moving_obstacles(scene) ? 256 : 0;
  for (int i = 0; i <= times; ++i)
    for (const Solid<double>& s : solids_in_metres(scene, scene.time.end * i / std::max(times, 1)))
      top = std::max(top, top_of(s, up));
  return top;
}

}  // namespace

std::vector<Solid<double>> solids_in_metres(const Scene& scene, double time) {
  const double h = scene.h();
  const auto [x, y, z] = scene.origin();
  std::vector<Solid<double>> solids = solids_of(scene, time);
  for (Solid<double>& s : solids) {
    s.center = Vec3<double>{x, y, z} + h * s.center;
    s.shape = s.shape.with(
        [&](const auto& shape) { return SomeShape<double>(shape.template scaled<double>(h)); });
  }
  return solids;
}

Reach reach_of(const Scene& scene, const Double3& up, std::int64_t particles) {
  const double g = length(scene.gravity);
  const std::vector<Solid<double>> solids = solids_in_metres(scene, 0);
  const StartVolume start(scene, up, solids);
  const std::vector<Parcel> parcels = start.parcels(particles);
  double volume = 0, energy = 0, fastest = 0, top = start.floor();
  for (const Parcel& p : parcels) volume += p.volume;
  const Rest rest = leaks(scene, up) ? Rest{start.floor(), start.floor()} : start.at_rest(volume);
  for (const Parcel& p : parcels) {
    const double square = dot(p.velocity, p.velocity), fall = p.height - rest.height;
    energy += p.volume * (0.5 * square + g * fall);
    if (p.volume >= kBodyShare * volume)
      fastest = std::max(fastest, std::sqrt(square + 2 * g * std::max(0.0, fall)));
    const double rising = std::max(0.0, dot(p.velocity, up));
    top = std::max(top, p.top + (g > 0 ? 0.5 * rising * rising / g : 0));
  }
  const double spread = volume > 0 ? std::max(0.0, energy / volume) : 0;

  const double obstacle = fastest_obstacle(scene, 0, scene.time.end);
  const Double3 box = scene.domain.max - scene.domain.min;
  const double tank = 2 * greatest_sway(scene, 0, scene.time.end) *
                      std::max({box[0], scene.plane() ? 0.0 : box[1], box[2]});
  Reach out;
  out.speed = std::max(std::hypot(std::max(kUneven * std::sqrt(2 * spread), kArriving * fastest),
                                  kPast * obstacle, std::sqrt(tank)),
                       std::sqrt(2 * g * kCalm * scene.fluid.spacing));
  if (!(out.speed > 0) || !std::isfinite(out.speed)) out.speed = 1;
  if (!(g > 0)) {
    out.height = std::numeric_limits<double>::infinity();
    return out;
  }
  const double thrown = kThrown * obstacle;
  out.height = std::max({top, rest.surface + kSplash * (spread + 0.5 * tank) / g,
                         rest.surface + kJet * 0.5 * fastest * fastest / g,
                         rest.surface + 0.5 * thrown * thrown / g, top_of_solids(scene, up)});
  return out;
}

}  // namespace pbf::render_module
