// What the kinds of gauges share: the way from SI units and the scene's axes to the internal frame.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "kernels/axes.h"
#include "kernels/boundary/obstacle.h"
#include "lib/base/text.h"
#include "lib/program/column.h"

namespace pbf::inline program_module {

struct GaugeFrame {
  const Scene& scene;
  const Axes& axes;
  const std::vector<Solid<double>>& solids;  ///< Plan::solids
  double mass;                               ///< kg, of one particle
  double force_grain;                        ///< N: load_grain() (lib/program/loads.h)
  int first = 0;  ///< number of sums of the gauges before this one that have sums of its type

  void place(const Double3& x, double (&to)[3]) const {
    const Double3 o = scene.origin();
    for (int k = 0; k < 3; ++k) {
      const auto a = std::size_t(axes.of[k]);
      to[k] = scene.dimensions == 2 && a == 1 ? 0 : (x[a] - o[a]) / scene.h();
    }
  }
  void direction(const Double3& v, double (&to)[3]) const {
    for (int k = 0; k < 3; ++k) to[k] = v[std::size_t(axes.of[k])];
  }
  /// Bound on the number of particles within h of a point: those in a cube of edge 2 h.
  double particles_around() const {
    return std::pow(2 * scene.h() / scene.fluid.spacing, scene.dimensions);
  }
};

inline std::string place_text(const Double3& x) {
  return format("(%.6g, %.6g, %.6g)", x[0], x[1], x[2]);
}
inline std::string place_text(const std::vector<double>& x) {
  return place_text(Double3{x[0], x[1], x[2]});
}

}  // namespace pbf::inline program_module
