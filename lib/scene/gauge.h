// A gauge as plain data: it records values at one place.
#pragma once

#include "lib/scene/kinds.h"

#define PBF_GAUGE_TEXT(path) #path
// clang-format off
#define PBF_GAUGE_FILE(name) PBF_GAUGE_TEXT(lib/scene/gauges/name.h)
// clang-format on
#include "lib/scene/gauges/list.h"

namespace pbf::inline scene_module {

namespace gauge_keys {
/// The keys of a kind, in the order of the list.
using Any = std::variant<PBF_GAUGES>;
}  // namespace gauge_keys

struct Gauge {
  std::string name;
  gauge_keys::Any kind{};
  bool operator==(const Gauge&) const = default;

  /// The obstacle or the wall on which it reads a share of the loads; null: it reads no loads.
  const std::string* on() const {
    return std::visit(
        [](const auto& keys) -> const std::string* {
          if constexpr (requires { keys.on; }) return &keys.on;
          return nullptr;
        },
        kind);
  }
};

}  // namespace pbf::inline scene_module
