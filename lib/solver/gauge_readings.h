// Gauge readings in SI units, and their data in the run file.
#pragma once

#include <string>
#include <vector>

#include "kernels/boundary/loads.h"
#include "lib/program/plan.h"

namespace pbf::inline solver_module {

/// The data of a gauge: one number or vector per reading; some kinds have a further number.
struct GaugeData {
  std::string name, kind, place;  ///< "P1", "pressure", "container at (0.82, 0.47, 0.02) m, ..."
  const char* unit = "m";
  int components = 1;
  const char* further = "";  ///< "total" (flow), "peak" (pressure); empty: none
  const char* further_unit = "";

  int numbers() const { return components + (*further ? 1 : 0); }
};

/// In the order of the scene.
std::vector<GaugeData> gauge_data(const Scene& scene);

/// The concatenated numbers of all gauges, GaugeData::numbers() of each. Level: m. Velocity: m/s
/// along the scene's axes, NaN if no particle is within h. Flow: kg/s, mean since the last reading,
/// and kg since the start. Pressure: Pa, mean since the last reading and largest mean of an update.
/// A mean over an interval of length 0 is 0.
std::vector<double> gauge_readings(const GaugeSums& sums, const Scene& scene, const Plan& plan);

}  // namespace pbf::inline solver_module
