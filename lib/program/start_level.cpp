#include "lib/program/start_level.h"

#include <algorithm>
#include <array>
#include <vector>

#include "lib/scene/body_box.h"
#include "lib/scene/surface.h"

namespace pbf::program_module {
namespace {

constexpr int kAcross = 24, kUp = 120;
enum Place : char { solid, dry, wet };
using PlacesUp = std::array<Place, kUp>;  ///< from the lowest one

/// s: without what is from files.
Place place_at(const Scene& s, const std::vector<BodyBox>& boxes, const Double3& x) {
  if (!is_free(s, x)) return solid;
  for (const BodyBox& box : boxes) {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a)
      inside &= (s.dimensions == 2 && a == 1) || (x[a] >= box.low[a] && x[a] <= box.high[a]);
    if (inside) return wet;
  }
  return dry;
}

/// A grid over the domain.
std::vector<PlacesUp> columns_of(const Scene& s) {
  const auto up = std::size_t(level_axis(s));
  const std::vector<int> across = axes_across_level(s);
  const bool turned = s.gravity[up] > 0;
  Scene plain = s;
  std::erase_if(plain.obstacles, [](const Obstacle& o) { return o.surface_file() != nullptr; });
  std::erase_if(plain.bodies, [](const Body& b) { return b.from_file(); });
  std::vector<BodyBox> boxes;
  for (const Body& b : plain.bodies) boxes.push_back(body_box(b));
  const Double3 edge = s.domain.max - s.domain.min;
  std::vector<PlacesUp> columns;
  const int rows = across.size() > 1 ? kAcross : 1;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < kAcross; ++i) {
      Double3 x = s.domain.min;
      const int number[] = {i, j};
      for (std::size_t k = 0; k < across.size(); ++k) {
        const auto a = std::size_t(across[k]);
        x[a] += (number[k] + 0.5) / kAcross * edge[a];
      }
      PlacesUp& column = columns.emplace_back();
      for (int k = 0; k < kUp; ++k) {
        const double z = (k + 0.5) / kUp * edge[up];
        x[up] = turned ? s.domain.max[up] - z : s.domain.min[up] + z;
        column[std::size_t(k)] = place_at(plain, boxes, x);
      }
    }
  return columns;
}

/// The height to which a volume fills what is not solid, if that is as high as the domain or less.
double filled(double volume, double floor, double height, const std::vector<PlacesUp>& columns) {
  const double dz = height / kUp;
  for (int k = 0; k < kUp; ++k) {
    const auto room = [&](const PlacesUp& c) { return c[std::size_t(k)] != solid; };
    const double free =
        floor * double(std::ranges::count_if(columns, room)) / double(columns.size());
    if (volume < free * dz) return k * dz + volume / free;
    volume -= free * dz;
  }
  return height;
}

}  // namespace

StartLevel start_level(const Scene& s) {
  const auto up = std::size_t(level_axis(s));
  const bool turned = s.gravity[up] > 0;
  const double height = s.domain.max[up] - s.domain.min[up];
  double floor = 1, held = 0;
  for (const int a : axes_across_level(s))
    floor *= s.domain.max[std::size_t(a)] - s.domain.min[std::size_t(a)];
  StartLevel level{0, height, 0, true};
  for (const Body& b : s.bodies) {
    if (b.from_file()) continue;
    const BodyBox box = body_box(b);
    double volume = box.high[up] - box.low[up];
    for (const int a : axes_across_level(s))
      volume *= box.high[std::size_t(a)] - box.low[std::size_t(a)];
    held += volume;
    const double ends[] = {
        turned ? s.domain.max[up] - box.high[up] : box.low[up] - s.domain.min[up],
        turned ? s.domain.max[up] - box.low[up] : box.high[up] - s.domain.min[up]};
    level.bottom = std::min(level.bottom, ends[0]), level.top = std::max(level.top, ends[1]);
  }
  const std::vector<PlacesUp> columns = columns_of(s);
  level.rest = filled(held, floor, height, columns);
  // Blocks end where whole spacings do.
  const double dz = height / kUp, surface = level.top - 1.01 * s.fluid.spacing - dz;
  for (const PlacesUp& column : columns)
    for (int k = 0; (k + 0.5) * dz < surface && k < kUp; ++k)
      if (column[std::size_t(k)] == dry) level.rests = false;
  return level;
}

}  // namespace pbf::program_module
