// A velocity gauge: the mean of the particles within h of a point, weighted with Poly6.
#pragma once

#include <limits>

#include "kernels/gauge_probe.h"
#include "lib/program/gauge_frame.h"

namespace pbf::inline program_module::gauge_kinds {

struct Velocity {
  using Keys = gauge_keys::Velocity;
  using Sums = ProbeSums;

  Probe site;
  Axes axes;
  double unit;  ///< m/s, of h per update
  Grain grains[1];

  Velocity(const Keys& keys, const GaugeFrame& frame)
      : axes(frame.axes), unit(frame.scene.h() / frame.scene.time.step) {
    frame.place({keys.at[0], keys.at[1], keys.at[2]}, site.from);
    site.moving = true;
    site.first = frame.first;
    grains[0].value = unit * frame.particles_around() / double(kProbeUnits);
  }
  static std::string place(const Keys& keys, const Scene&) { return place_text(keys.at) + " m"; }
  int sums() const { return 1; }
  void finish(const ProbeSums* s, double* out) const {
    const bool wet = double(s->weight) / double(kProbeUnits) > 1e-6;
    for (int k = 0; k < 3; ++k)
      out[axes.of[k]] = wet ? unit * double(s->way[k]) / double(s->weight)
                            : std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace pbf::inline program_module::gauge_kinds
