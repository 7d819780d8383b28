// The velocity of the fluid around a point.
#pragma once

#include "lib/scene/gauges/keys.h"

namespace pbf::inline scene_module::gauge_keys {

struct Velocity {
  static constexpr const char* word = "velocity";
  static constexpr const char* about = "that of the fluid within h (m/s), nan where there is none";
  static constexpr std::array columns{GaugeColumn{"", "m/s", Join::now, 3}};
  std::vector<double> at{};  ///< m
  bool operator==(const Velocity&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Velocity::at, "at", "m", kCoordinate, kAtHelp, true, FlatY::middle, false, 3}};
  }
  void check(auto& rules) const {
    if (rules.good(at) && rules.is_place(at)) rules.inside(at, {at[0], at[1], at[2]});
  }
};

}  // namespace pbf::inline scene_module::gauge_keys
