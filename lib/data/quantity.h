// Readings of a run by name: where they are in its file, in which unit.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/program/column.h"
#include "lib/scene/compare.h"

namespace pbf::data_module {

/// A column of readings.
struct ReadingSite {
  std::string unit;
  int components = 1;
  bool means = false;  ///< each is the mean since the one before (TimeSeries::means)
};

/// The readings that a run has: `find` by path below /pbf ("gauges/H2", "log/front_x"), `names` of
/// all paths, for messages.
struct Readings {
  std::function<std::optional<ReadingSite>(const std::string& path)> find;
  std::function<std::vector<std::string>()> names;
};
/// Those that a run will have; columns: of its plan; work: whether something moves (has_work()).
Readings readings_of(const std::vector<ReadingColumn>& columns, bool work);
/// Those of a file. The reader must outlive them.
Readings readings_of(const RunReader& file);

/// A reading that is compared.
struct Quantity {
  std::string path;  ///< "gauges/U", "log/load/post/force_x"
  int component = 0;
  ReadingSite site;
  /// How a column of a table is named that holds it, without its unit: "U_x"; "load_post_x", ...
  std::vector<std::string> names;
};
/// Whether an entry was given by options, whose place is then "--gauge H2=H2_m".
inline bool by_options(const Comparison& entry) { return entry.place.text.starts_with("--"); }
/// How a key of an entry is written: time_scale in a scene, --time-scale as an option.
std::string key_word(const Comparison& entry, const std::string& key);
/// That of an entry of `compare`. Throws Error(bad_input) beginning with `key` if there is none.
Quantity quantity_of(const Comparison& entry, const Readings& readings, const std::string& key);

/// The path of the times of a reading: "gauges/time".
std::string time_path(const std::string& path);

/// Its readings in a run.
struct QuantitySeries {
  std::vector<double> time, value;  ///< s, in its unit
};
QuantitySeries read_quantity(const RunReader& file, const Quantity& quantity);
/// The same from the column of its path, and that of the times beside it.
QuantitySeries series_of(const RunColumn& own, const RunColumn& time, const Quantity& quantity);
/// Without the first number of means, which is over no time.
QuantitySeries without_start(QuantitySeries series, const Quantity& quantity);

}  // namespace pbf::data_module
