// A level: the wetted length of a line through the domain.
#pragma once

#include "lib/scene/gauges/keys.h"

namespace pbf::inline scene_module::gauge_keys {

struct Level {
  static constexpr const char* word = "level";
  static constexpr const char* about = "the wetted length of a line along gravity's axis (m)";
  static constexpr std::array columns{GaugeColumn{"", "m", Join::now}};
  std::vector<double> at{};  ///< m, coordinates across the line
  bool operator==(const Level&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Level::at, "at", "m", kCoordinate, kAtHelp, true, FlatY::none, false, 3}};
  }
  void check(auto& rules) const {
    if (!rules.good(at)) return;
    const std::vector<int> across = axes_across_level(rules.scene());
    std::string wanted;
    for (const int a : across) wanted += (wanted.empty() ? "[" : ", ") + rules.axis(a);
    if (at.size() != across.size())
      return rules.add(at, "has " + rules.count(at) + ", and a level is read along " +
                               rules.axis(level_axis(rules.scene())) + ", the axis of gravity" +
                               (rules.flat() ? ", with dimensions: 2" : "") + "; give " + wanted +
                               "]");
    Double3 place = rules.scene().domain.min;
    for (std::size_t k = 0; k < across.size(); ++k) place[std::size_t(across[k])] = at[k];
    rules.inside(at, place);
  }
};

}  // namespace pbf::inline scene_module::gauge_keys
