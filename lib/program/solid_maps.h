// The maps of obstacles with surfaces from files (kernels/shapes/mesh.h) in the memory of a solver:
// one array for all.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "lib/program/feature.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

inline bool has_maps(const Scene& s) {
  return std::ranges::any_of(s.obstacles, [](const Obstacle& o) { return o.surface_file(); });
}

/// The rows, of four real numbers each, at which the parts of a map begin.
struct MapRows {
  std::int64_t shares = 0, away = 0, brick = 0, end = 0;
  /// real: bytes of a number.
  MapRows(std::int64_t first, const shape::Mesh<double>& map, std::int64_t real) {
    const auto rows = [&](std::int64_t bytes) { return (bytes + 4 * real - 1) / (4 * real); };
    shares = first;
    away = shares + map.nodes();
    brick = away + rows(map.nodes() * real);
    end = brick + rows(map.all_bricks() * std::int64_t(sizeof(int)));
  }
};

/// Calls f(number of the solid, map, rows, whether no earlier solid has the same map) for each
/// solid with a map. Returns the number of all rows.
template <class F>
std::int64_t for_each_map(const std::vector<Solid<double>>& solids, std::int64_t real, F&& f) {
  struct Known {
    const int* brick;
    MapRows rows;
  };
  std::vector<Known> known;
  std::int64_t end = 0;
  for (std::size_t k = 0; k < solids.size(); ++k) {
    if (!solids[k].shape.is<shape::Mesh<double>>()) continue;
    const auto map = solids[k].shape.as<shape::Mesh<double>>();
    const auto there = std::ranges::find(known, map.brick, &Known::brick);
    const bool first = there == known.end();
    const MapRows rows = first ? MapRows(end, map, real) : there->rows;
    if (first) known.push_back({map.brick, rows}), end = rows.end;
    f(k, map, rows, first);
  }
  return end;
}

inline std::int64_t per_map_row(const Sizes& n) {
  const std::int64_t real = n.scene.precision == Precision::single ? 4 : 8;
  return for_each_map(n.plan.solids, real, [](auto&&...) {});
}

}  // namespace pbf::program_module

namespace pbf::program_module::field {
inline constexpr struct SolidMaps : Vectors {
} solid_maps{{"solid maps", per_map_row, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

/// All maps in one array.
template <class Real>
std::vector<Vec4<Real>> map_array(const std::vector<Solid<double>>& solids) {
  std::vector<Vec4<Real>> all;
  for_each_map(solids, sizeof(Real),
               [&](std::size_t, const auto& map, const MapRows& at, bool first) {
                 if (!first) return;
                 all.resize(std::size_t(at.end));
                 auto* away = reinterpret_cast<Real*>(&all[std::size_t(at.away)]);
                 for (std::int64_t k = 0; k < map.nodes(); ++k) {
                   const Vec4<double>& v = map.shares[k];
                   all[std::size_t(at.shares + k)] = {Real(v.x), Real(v.y), Real(v.z), Real(v.w)};
                   away[k] = Real(map.away[k]);
                 }
                 std::memcpy(&all[std::size_t(at.brick)], map.brick,
                             std::size_t(map.all_bricks()) * sizeof(int));
               });
  return all;
}

/// Gives solids the addresses of their maps in the memory of a solver.
template <class Real>
class MapAddresses {
 public:
  MapAddresses() = default;
  /// solids: of the plan; base: of map_array().
  MapAddresses(const std::vector<Solid<double>>& solids, const Vec4<Real>* base) {
    for_each_map(solids, sizeof(Real), [&](std::size_t k, const auto&, const MapRows& at, bool) {
      of_.resize(solids.size());
      of_[k] = {base + at.shares, reinterpret_cast<const Real*>(base + at.away),
                reinterpret_cast<const int*>(base + at.brick)};
    });
  }
  void set(std::size_t number, Solid<Real>& solid) const {
    if (!solid.shape.template is<shape::Mesh<Real>>()) return;
    auto map = solid.shape.template as<shape::Mesh<Real>>();
    map.shares = of_[number].shares, map.away = of_[number].away, map.brick = of_[number].brick;
    solid.shape = map;
  }

 private:
  struct Parts {
    const Vec4<Real>* shares = nullptr;
    const Real* away = nullptr;
    const int* brick = nullptr;
  };
  std::vector<Parts> of_;
};

}  // namespace pbf::PBF_VARIANT
