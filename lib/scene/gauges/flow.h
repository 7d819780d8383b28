// The flow through a rectangle.
#pragma once

#include "lib/scene/gauges/keys.h"

namespace pbf::inline scene_module::gauge_keys {

struct Flow {
  static constexpr const char* word = "flow";
  static constexpr const char* about =
      "mass through a rectangle per time (kg/s), and all of it (kg)";
  static constexpr std::array columns{GaugeColumn{"", "kg/s", Join::mean},
                                      GaugeColumn{"total", "kg", Join::total}};
  static constexpr int most = 32;  ///< bits of a side (kernels/pass_flow.h)
  Double3 center{};                ///< m, middle of the rectangle
  Double3 normal{1, 0, 0};         ///< the positive direction
  std::vector<double> size{};  ///< m, the level edge and the other; in two dimensions one length
  bool operator==(const Flow&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Flow::center, "center", "m", kCoordinate, "Middle of the rectangle.", true,
                FlatY::middle},
        KindKey{&Flow::normal, "normal", "", Range{-1e6, 1e6},
                "At right angles to the rectangle; flow this way counts as positive.", true,
                FlatY::zero},
        KindKey{&Flow::size, "size", "m", Range{1e-9, 1e12},
                "Its edges: the level one (along x where the normal is along z), then the other. "
                "In two dimensions the length of a line, [size].",
                true, FlatY::none, false, 2}};
  }
  void check(auto& rules) const {
    if (rules.good(normal) && dot(normal, normal) == 0)
      rules.add(normal, "has no direction; give the way that counts as positive, [1, 0, 0] say");
    else if (rules.good(normal) && rules.flat() && normal[1] != 0)
      rules.add(normal,
                "has a y component, with dimensions: 2 nothing flows along y; give 0 for y");
    const std::size_t edges = rules.flat() ? 1 : 2;
    if (rules.good(size) && size.size() != edges)
      rules.add(size,
                "has " + rules.count(size) + ", expected " +
                    (rules.flat() ? "one, the length of a line in the x-z plane (dimensions: 2)"
                                  : "two, the edges of a rectangle"));
    if (rules.good(center)) rules.inside(center, center);
  }
};

}  // namespace pbf::inline scene_module::gauge_keys
