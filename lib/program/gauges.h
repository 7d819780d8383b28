// The gauges of a scene in the form that the kernels use. A tally (kernels/gauge_probe.h) is a way
// to make the sums behind readings; the kinds of gauges that share one are its gauges.
#pragma once

#include <algorithm>
#include <functional>
#include <tuple>
#include <type_traits>
#include <vector>

#include "lib/program/column.h"

namespace pbf::program_module {

/// Number of the scene's gauges of a tally.
template <class Tally>
int gauges_of(const Scene& scene) {
  return int(std::ranges::count_if(scene.gauges, [](const Gauge& g) {
    return std::visit(
        []<class Keys>(const Keys&) { return std::is_same_v<typename Keys::Tally, Tally>; },
        g.kind);
  }));
}

/// In the order of the scene.
template <class Tally>
struct TalliedGauges {
  std::vector<typename Tally::Site> sites;
  int sums = 0;  ///< number of sums of all
};
template <class Tally>
struct TallySums {
  std::vector<typename Tally::Sums> rows;
};
/// The sums of one reading.
using GaugeSums = gauge_keys::EachTally<TallySums>;

struct GaugePlan {
  gauge_keys::EachTally<TalliedGauges> tallies;
  std::vector<ReadingColumn> columns;  ///< gauge after gauge
  std::vector<std::function<std::vector<double>(const GaugeSums&)>> finish_each;  ///< by gauge

  template <class Tally>
  const TalliedGauges<Tally>& of() const {
    return std::get<TalliedGauges<Tally>>(tallies);
  }
  /// The numbers of a reading in SI units.
  std::vector<double> finish(const GaugeSums& sums) const;
};

/// `plan`: with its axes, solids and mass.
GaugePlan plan_gauges(const Scene& scene, const Plan& plan);

}  // namespace pbf::program_module
