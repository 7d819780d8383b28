// The pressure on a disc of a surface.
#pragma once

#include "lib/scene/gauges/keys.h"

namespace pbf::inline scene_module::gauge_keys {

struct Pressure {
  static constexpr const char* word = "pressure";
  static constexpr const char* about =
      "the normal load on a disc of a surface over its area (Pa), mean and peak";
  static constexpr std::array columns{GaugeColumn{"", "Pa", Join::mean},
                                      GaugeColumn{"peak", "Pa", Join::peak}};
  std::vector<double> at{};  ///< m
  std::string on{};          ///< an obstacle, or a wall of the domain
  double radius = 0;         ///< m, of the disc
  bool operator==(const Pressure&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Pressure::at, "at", "m", kCoordinate, kAtHelp, true, FlatY::middle, false, 3},
        KindKey{&Pressure::on, "on", "", Range{},
                "The obstacle, or the wall of the domain (x_min), that `at` lies on."},
        KindKey{&Pressure::radius, "radius", "m", kLength,
                "Of the disc, of which what lies on the surface counts; at least 2 fluid.spacing. "
                "In two dimensions half the length of a strip."}};
  }
  void check(auto& rules) const { rules.check_disc(at, on, radius); }
};

}  // namespace pbf::inline scene_module::gauge_keys
