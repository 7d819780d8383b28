// The range of a colour bar from what the frames of a run hold.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lib/render/renderer.h"

namespace pbf::render_module {

/// Collects what colours the particles of some frames. Of more than 2^24 values every second,
/// third ... is taken, so that memory stays below 128 MiB.
class QuantileRange {
 public:
  /// `total`: particles of all frames to come.
  QuantileRange(const View& view, std::int64_t total);
  /// Error(bad_input) when the snapshot lacks the field. Values that are not finite are left out.
  void add(const Snapshot& snapshot);
  std::int64_t stride() const { return stride_; }  ///< every so many values are taken

  /// The values with the shares `low` and `high` (0..1) of all below them, straight between
  /// neighbors in their order, as numpy.quantile. Error(bad_input) where there is no value. Both
  /// are equal where all values are. Takes the values apart: call it once.
  std::array<double, 2> between(double low, double high);

 private:
  const View& view_;
  std::int64_t stride_ = 1, seen_ = 0;
  std::vector<double> values_;
};

/// A colour bar from quantile to quantile.
struct BarRange {
  std::array<double, 2> ends;
  std::string text;  ///< "LOW,HIGH": these very numbers, for --range
};

/// For the density the quantiles are moved apart to lie as far below as above rest_density, whose
/// colour is the middle of the map.
BarRange bar_range(const View& view, std::array<double, 2> quantiles);

}  // namespace pbf::render_module
