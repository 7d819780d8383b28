// A pressure gauge: the share of a disc in the load of its surface, over the wetted area.
#pragma once

#include "kernels/boundary/loads.h"
#include "lib/program/gauge_frame.h"

namespace pbf::inline program_module::gauge_kinds {

struct Pressure {
  using Keys = gauge_keys::Pressure;
  using Sums = Load;

  Patch site;
  double area;  ///< m^2, integral of patch_share() over the part of the surface that fluid touches
  double unit;  ///< Pa s, of a particle with h/s
  Grain grains[2];

  Pressure(const Keys& keys, const GaugeFrame& frame);
  static std::string place(const Keys& keys, const Scene&) {
    return keys.on + " at " + place_text(keys.at) + format(" m, radius %.6g m", keys.radius);
  }
  int sums() const { return 1; }
  void finish(const Load* l, double* out) const {
    out[0] = l->time > 0 ? unit * l->impulse[0] / l->time : 0;
    out[1] = unit * l->peak;
  }
};

}  // namespace pbf::inline program_module::gauge_kinds
