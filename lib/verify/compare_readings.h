// Loads on walls and obstacles, and gauge readings, as numbers to compare.
#pragma once

#include <string>
#include <vector>

#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::verify_module {

struct Reading {
  std::string stage;  ///< "loads" or "gauges"
  std::string what, unit;
  double value = 0;
  double scale = 0;  ///< reference for rounding if it is more than |value|
  double grain = 0;  ///< ReadingColumn::grain, of this interval
};

/// Readings of the last `updates` updates, since the last call or since a state with empty sums was
/// set. Empty if the scene has neither loads nor gauges.
std::vector<Reading> take_readings(Solver& solver, const Scene& scene, const Plan& plan,
                                   int updates);

/// The reading of this name; null if there is none.
const Reading* find_reading(const std::vector<Reading>& readings, const std::string& what);

}  // namespace pbf::verify_module
