// The gauges of a scene in the form that the kernels use. A kind of gauges (lib/program/gauges/) is
// a struct made from its keys, with
//   site            what the kernels know of it, plain data in the internal frame
//   Sums, sums()    type and number of the sums behind a reading; how they are made follows from
//   the
//                   type: FlowCount at the end of updates, Load with the loads of walls, any other
//                   at a reading by gauge_pass() (kernels/gauge_probe.h)
//   finish()        the numbers of a reading from the sums, in SI units
//   grains          of its columns
//   place()         where it is, for readers of the run file
#pragma once

#include <algorithm>
#include <type_traits>
#include <variant>
#include <vector>

// clang-format off
#define PBF_GAUGE_FILE(name) PBF_GAUGE_TEXT(lib/program/gauges/name.h)
// clang-format on
#include "lib/scene/gauges/list.h"

namespace pbf::inline program_module {

namespace gauge_kinds {
using Any = std::variant<PBF_GAUGES>;
}  // namespace gauge_kinds

/// Whether sums are made by a pass over the particles at a reading.
template <class Sums>
inline constexpr bool is_probe = !std::is_same_v<Sums, FlowCount> && !std::is_same_v<Sums, Load>;

/// Whether the scene has gauges with sums of a type.
template <class Sums>
bool has_gauges(const Scene& scene) {
  return [&]<class... Kind>(const std::variant<Kind...>*) {
    constexpr bool has[] = {std::is_same_v<typename Kind::Sums, Sums>...};
    return std::ranges::any_of(scene.gauges, [&](const Gauge& g) { return has[g.kind.index()]; });
  }(static_cast<const gauge_kinds::Any*>(nullptr));
}

/// In the order of the scene.
struct GaugePlan {
  std::vector<gauge_kinds::Any> all;

  /// Calls f(gauge, number) for those with sums or sites of this type; number: of the first number
  /// of its reading among those of all gauges, whose number is returned.
  template <class T, class F>
  std::size_t for_each(F&& f) const {
    std::size_t number = 0;
    for (const gauge_kinds::Any& any : all)
      std::visit(
          [&]<class Kind>(const Kind& gauge) {
            if constexpr (std::is_same_v<typename Kind::Sums, T> ||
                          std::is_same_v<decltype(Kind::site), T>)
              f(gauge, number);
            for (const GaugeColumn& c : Kind::Keys::columns) number += std::size_t(c.components);
          },
          any);
    return number;
  }
  /// Of a reading of all gauges.
  std::size_t numbers() const {
    return for_each<void>([](const auto&, std::size_t) {});
  }
  template <class Site>
  std::vector<Site> sites() const {
    std::vector<Site> out;
    for_each<Site>([&](const auto& gauge, std::size_t) { out.push_back(gauge.site); });
    return out;
  }
  /// Number of sums of a type.
  template <class Sums>
  int sums() const {
    int n = 0;
    for_each<Sums>([&](const auto& gauge, std::size_t) { n += gauge.sums(); });
    return n;
  }
  /// Puts the numbers of the gauges with these sums to their places among the readings of all.
  template <class Sums>
  void finish(const std::vector<Sums>& sums, std::vector<double>& readings) const {
    const Sums* next = sums.data();
    for_each<Sums>([&](const auto& gauge, std::size_t number) {
      gauge.finish(next, &readings[number]);
      next += gauge.sums();
    });
  }
};

/// `force_grain`: load_grain() (lib/program/loads.h).
GaugePlan plan_gauges(const Scene& scene, const Axes& axes,
                      const std::vector<Solid<double>>& solids, double mass, double force_grain);

}  // namespace pbf::inline program_module
