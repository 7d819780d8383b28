#include "lib/render/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/program/emission.h"
#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "lib/scene/body_box.h"
#include "lib/scene/lattice.h"
#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

// Of a StartVolume.
constexpr int kCells = 48, kFlatCells = 128;  // along an axis
constexpr int kSlices = 4;                    // of heights in a cell
constexpr int kSamples = 24;                  // of a round body along an axis

// Of an estimate.
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

/// Whether a free body does not move along the axis that is nearest to `up`.
bool is_held_along(const FreeBody& body, const Double3& up) {
  std::size_t most = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::fabs(up[k]) > std::fabs(up[most])) most = k;
  return body.locks(kLockNames[most]);
}

/// m along `up`, of the highest place of a solid; of a plane nothing.
double top_of(const Solid<double>& s, const Double3& up) {
  const Vec3<double> way{up[0], up[1], up[2]};
  return is_bounded(s) ? dot(s.center, way) + reach_along(s, way, false)
                       : -std::numeric_limits<double>::infinity();
}

/// m along `up`, of the highest place of any obstacle between start and end; of free bodies at the
/// start, since the fluid decides where they are later.
double top_of_solids(const Scene& scene, const Double3& up) {
  double top = -std::numeric_limits<double>::infinity();
  const int times = has_prescribed_obstacles(scene) ? 256 : 0;
  for (int i = 0; i <= times; ++i)
    for (const Solid<double>& s : solids_in_metres(scene, scene.time.end * i / std::max(times, 1)))
      top = std::max(top, top_of(s, up));
  return top;
}

}  // namespace

StartVolume::StartVolume(const Scene& scene, const Double3& up,
                         const std::vector<Solid<double>>& solids)
    : scene_(scene), up_(up), solids_(solids) {
  const bool flat = scene.dimensions == 2;
  cells_.fill(flat ? kFlatCells : kCells);
  if (flat) cells_[1] = 1;
  double reach = 0;  // along `up`, of a cell
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = scene.domain.min[k], high = scene.domain.max[k];
    edge_[k] = (high - low) / cells_[k];
    low_ += std::min(up[k] * low, up[k] * high);
    high_ += std::max(up[k] * low, up[k] * high);
    reach += std::abs(up[k]) * edge_[k];
  }
  layers_.assign(static_cast<std::size_t>(kSlices) * (flat ? kFlatCells : kCells), 0);
  const double slice = (high_ - low_) / static_cast<double>(layers_.size());
  open_.reserve(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]);
  for (int k = 0; k < cells_[2]; ++k)
    for (int j = 0; j < cells_[1]; ++j)
      for (int i = 0; i < cells_[0]; ++i) {
        const Double3 middle = corner({i, j, k}) + 0.5 * edge_;
        open_.push_back(is_open(middle));
        if (!open_.back()) continue;
        // The cell's volume over the slices that its heights cross.
        const double from = (dot(middle, up_) - 0.5 * reach - low_) / slice;
        const double to = from + reach / slice;
        for (auto n = static_cast<std::ptrdiff_t>(std::floor(from + 1e-6)); n < to - 1e-6; ++n)
          layers_[static_cast<std::size_t>(
              std::clamp<std::ptrdiff_t>(n, 0, std::ssize(layers_) - 1))] +=
              edge_[0] * edge_[1] * edge_[2] *
              (std::min(to, static_cast<double>(n + 1)) - std::max(from, static_cast<double>(n))) /
              (to - from);
      }
}

Double3 StartVolume::corner(const std::array<int, 3>& cell) const {
  Double3 x = scene_.domain.min;
  for (std::size_t k = 0; k < 3; ++k) x[k] += cell[k] * edge_[k];
  return x;
}

bool StartVolume::is_open(const Double3& place) const {
  const Vec3<double> x{place[0], place[1], place[2]};
  return std::ranges::all_of(solids_, [&](const Solid<double>& s) {
    return (scene_.dimensions == 2 ? distance<2>(s, x) : distance<3>(s, x)) > 0;
  });
}

// A box's part of each cell, so that a pool with a level surface is exactly the volume at rest.
Parcel StartVolume::of_block(const scene_module::Body& body) const {
  Parcel out;
  std::array<int, 3> from{}, to{};
  Double3 low = body.min, high = body.max;
  if (scene_.dimensions == 2) low[1] = scene_.domain.min[1], high[1] = scene_.domain.max[1];
  for (std::size_t k = 0; k < 3; ++k) {
    const double width = edge_[k], start = scene_.domain.min[k];
    from[k] = static_cast<int>(std::clamp((low[k] - start) / width, 0.0, cells_[k] - 1.0));
    to[k] = static_cast<int>(std::clamp((high[k] - start) / width, 0.0, cells_[k] - 1.0));
  }
  double moment = 0;
  for (int k = from[2]; k <= to[2]; ++k)
    for (int j = from[1]; j <= to[1]; ++j)
      for (int i = from[0]; i <= to[0]; ++i) {
        if (!open_[(static_cast<std::size_t>(k) * cells_[1] + j) * cells_[0] + i]) continue;
        const Double3 begin = corner({i, j, k});
        double part = 1, middle = 0, half = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double x0 = std::max(begin[a], low[a]), x1 = std::min(begin[a] + edge_[a], high[a]);
          part *= std::max(0.0, x1 - x0);
          middle += up_[a] * 0.5 * (x0 + x1), half += std::abs(up_[a]) * 0.5 * (x1 - x0);
        }
        if (part <= 0) continue;
        out.volume += part, moment += part * middle;
        out.top = std::max(out.top, middle + half);
      }
  if (out.volume > 0) out.height = moment / out.volume;
  return out;
}

Parcel StartVolume::of_shape(const scene_module::Body& body) const {
  Parcel out;
  const BodyBox box = body_box(body);
  const std::array<int, 3> n{kSamples, scene_.plane() ? 1 : kSamples, kSamples};
  Double3 edge{}, low = box.low;
  for (std::size_t k = 0; k < 3; ++k) edge[k] = (box.high[k] - box.low[k]) / n[k];
  if (const auto plane = scene_.plane()) {
    edge[1] = scene_.domain.max[1] - scene_.domain.min[1];
    low[1] = *plane - 0.5 * edge[1];
  }
  double moment = 0, half = 0;
  for (std::size_t k = 0; k < 3; ++k) half += 0.5 * std::abs(up_[k]) * edge[k];
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const Double3 x{low[0] + (i + 0.5) * edge[0], low[1] + (j + 0.5) * edge[1],
                        low[2] + (k + 0.5) * edge[2]};
        if (!is_in(body, x, 0) || !is_open(x)) continue;
        const double height = dot(x, up_);
        out.volume += edge[0] * edge[1] * edge[2];
        moment += edge[0] * edge[1] * edge[2] * height;
        out.top = std::max(out.top, height + half);
      }
  if (out.volume > 0) out.height = moment / out.volume;
  return out;
}

std::vector<Parcel> StartVolume::parcels(std::int64_t particles) const {
  std::vector<Parcel> out;
  const double cell = scene_.cell_volume();
  double known = 0, files = 0;
  for (const scene_module::Body& body : scene_.bodies)
    if (body.from_file())
      files += 1;
    else
      known += lattice_count(body, scene_.fluid.spacing, scene_.plane());
  for (const scene_module::Body& body : scene_.bodies) {
    Parcel parcel;
    switch (body.shape) {
      case Shape::block:
        parcel = of_block(body);
        break;
      case Shape::random_box:
        parcel = of_block(body);
        parcel.volume = cell * static_cast<double>(body.count);
        break;
      case Shape::sphere:
      case Shape::cylinder:
        parcel = of_shape(body);
        break;
      case Shape::file:
      case Shape::mesh:
        parcel = {cell * std::max(0.0, static_cast<double>(particles) - known) / files,
                  0.5 * (low_ + high_),
                  high_,
                  {}};
        break;
    }
    parcel.velocity = body.velocity;
    if (parcel.volume > 0) out.push_back(parcel);
  }
  return out;
}

Rest StartVolume::at_rest(double volume) const {
  const double slice = (high_ - low_) / static_cast<double>(layers_.size());
  double left = volume, moment = 0, level = low_;
  for (const double space : layers_) {
    if (left <= 0) break;
    const double taken = std::min(left, space);
    const double filled = space > 0 ? slice * taken / space : slice;
    moment += taken * (level + 0.5 * filled);
    level += filled;
    left -= taken;
  }
  const double held = volume - std::max(left, 0.0);
  return {held > 0 ? moment / held : low_, level};
}

std::vector<Solid<double>> solids_in_metres(const Scene& scene, double time) {
  const double h = scene.h();
  const auto [x, y, z] = scene.origin();
  std::vector<Solid<double>> solids = solids_of(scene, time);
  for (const Solid<double>& casing : casings_of(scene)) solids.push_back(casing);
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
  // A body that falls throws up fluid as a parcel does.
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const auto& body = scene.obstacles[k].free;
    if (!body || is_held_along(*body, up)) continue;
    const Vec3<double>& c = solids[k].center;
    const double fall = dot(Double3{c.x, c.y, c.z}, up) - rest.surface;
    fastest = std::max(
        fastest, std::sqrt(dot(body->velocity, body->velocity) + 2 * g * std::max(0.0, fall)));
  }
  const double spread = volume > 0 ? std::max(0.0, energy / volume) : 0;

  const double obstacle = std::max(fastest_obstacle(scene, 0, scene.time.end),
                                   fastest_emitter(scene, 0, scene.time.end));
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
