// A level gauge: where fluid fills half of the free space along a line.
#pragma once

#include "kernels/gauge_probe.h"
#include "lib/program/gauge_frame.h"

namespace pbf::inline program_module::gauge_kinds {

struct Level {
  using Keys = gauge_keys::Level;
  using Sums = ProbeSums;
  /// The interval between two sample points.
  struct Piece {
    double from = 0, to = 1;  ///< the part of it outside of obstacles, as fractions
  };

  Probe site;
  std::vector<double> room{};   ///< at each point, the share of the kernel outside of solids
  std::vector<Piece> pieces{};  ///< between the points
  double h, weight;             ///< m; ProbeSums::weight times this is the volume fraction of fluid
  Grain grains[1];

  Level(const Keys& keys, const GaugeFrame& frame);
  static std::string place(const Keys& keys, const Scene& scene);
  int sums() const { return site.count; }
  void finish(const ProbeSums* sums, double* out) const;
};

}  // namespace pbf::inline program_module::gauge_kinds
