// Reads what readings are compared with: a column of a CSV table, or the reading of another run.
#pragma once

#include <string>
#include <vector>

#include "lib/data/quantity.h"
#include "lib/data/series.h"
#include "lib/scene/compare.h"

namespace pbf::data_module {

/// A measured series in the unit of the reading that it is compared with.
struct Measured {
  std::vector<double> time, value;  ///< s, not decreasing; NaN: not measured
  bool means = false;               ///< TimeSeries::means
  std::string file, column;         ///< where it comes from
  std::string sha256;               ///< of the bytes of the table; empty for a run
  TimeSeries series() const { return {time, value, means}; }
};

/// The series of an entry of `compare`; `folder` anchors its path. `key`: the key of the path with
/// its place, for messages. Throws Error(bad_input) that names file, column and remedy for unknown
/// columns, units that are missing or of another quantity, times that do not increase and cells
/// that are no numbers; Error(io).
Measured read_measured(const Comparison& entry, const Quantity& quantity, const std::string& folder,
                       const std::string& key);

}  // namespace pbf::data_module
