// Loads on walls and obstacles, and gauge readings, as numbers to compare.
#pragma once

#include <string>
#include <vector>

#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::inline verify_module {

struct Reading {
  const char* stage = "";  ///< "loads" or "gauges"
  std::string what, unit;
  double value = 0;
  double scale = 0;  ///< what rounding is relative to where that is more than |value|
  /// What is added up are whole numbers (kLoadUnits, kProbeUnits, particles): by so much sums may
  /// differ of terms that differ by nothing but their last bits.
  double grain = 0;
};

/// Of the last `updates` updates, since this was called or a state was set whose sums are empty.
/// None where the scene has neither loads nor gauges.
std::vector<Reading> take_readings(Solver& solver, const Scene& scene, const Plan& plan,
                                   int updates);

/// The one of that name; null where there is none.
const Reading* find_reading(const std::vector<Reading>& readings, const std::string& what);

}  // namespace pbf::inline verify_module
