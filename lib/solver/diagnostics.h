// The table of what a run reports about its state. The log of the run file, the lines of
// --log-json, a study's measures, a batch's summary and the help are printed from it; formulas:
// DIAGNOSTICS.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/measure.h"
#include "lib/program/plan.h"
#include "lib/solver/measures.h"

namespace pbf::inline solver_module {

/// Sums in the internal frame, after so many updates and steps -> Measures in SI units and the
/// scene's axes (lib/solver/DIAGNOSTICS.md).
Measures to_measures(const MeasureSums& sums, const Scene& scene, const Plan& plan,
                     std::int64_t update, std::int64_t steps);

/// How a study sums a measure up over its window.
enum class Over { none, mean, rms, max, last };

struct Diagnostic {
  const char* name;  ///< of the column; the components of a vector end in _x, _y, _z
  const char* unit;  ///< "1": none
  const char* help;  ///< a phrase; empty for the further components of a vector
  Over over;         ///< none: not in a study's table
  bool summary;      ///< a column of a batch's summary.csv
  double (*number)(const Measures&);  ///< null for a whole number
  std::int64_t (*integer)(const Measures&) = nullptr;

  double value(const Measures& m) const { return number ? number(m) : double(integer(m)); }
};

/// In the order of the log's columns.
const std::vector<Diagnostic>& diagnostics();

/// A line for each, with its unit.
std::string diagnostics_help();

}  // namespace pbf::inline solver_module
