// The parts of a kind of gauges in scenes. A kind is a struct with its keys as members (m) and
//   word            its name in scenes
//   about           what it reads, with units, for the help
//   columns         the data of a reading, in this order; the first one has the gauge's own name
//   keys()          its rows in the table of keys (KindKey), in the order of pages
//   check(rules)    checks rules between its keys, by GaugeRules (lib/scene/check_gauges.cpp)
#pragma once

#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "lib/scene/key_traits.h"
#include "lib/scene/vector3.h"

namespace pbf::inline scene_module {

/// What a number of a reading is: the value at its update, the mean or the largest value of the
/// updates since the last reading, or the sum since the start.
enum class Join { now, mean, peak, total };

/// Data of a reading: one number, or the components of a vector.
struct GaugeColumn {
  const char* name;  ///< "total"; empty for the first one
  const char* unit;
  Join join;
  int components = 1;
};

namespace gauge_keys {
inline constexpr const char* kAtHelp =
    "Of a level where the line is along the other axes, [x, y], in two dimensions [x]; else the "
    "place, [x, y, z].";
}  // namespace gauge_keys
}  // namespace pbf::inline scene_module
