// Compares readings of a run with measurements, as a scene's `compare` asks for: the one
// implementation behind runs, batches, studies, `pbf compare-data` and the Python tools.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lib/base/json.h"
#include "lib/data/measured.h"
#include "lib/data/quantity.h"
#include "lib/io/run_file.h"
#include "lib/scene/scene.h"

namespace pbf::data_module {

/// An entry of `compare` with its data.
struct DataComparison {
  Comparison entry;
  Quantity own;
  Measured data;
};

/// Reads the data of entries and checks all that is known before a run: names, units, and whether
/// enough of the measured times lie between 0 and `end` (s). `folder` anchors paths. Throws
/// Error(bad_input), which names key, file and remedy, and Error(io).
std::vector<DataComparison> read_comparisons(const std::vector<Comparison>& entries,
                                             const Readings& readings, double end,
                                             const std::string& folder);

/// Gives the readings of a quantity.
using OwnSeries = std::function<QuantitySeries(const Quantity&)>;

/// The results, in the order of the entries. One that cannot be compared has no numbers and a
/// `note` that says why. Numbers: rms, rms_relative (over the range of the data), bias,
/// correlation, points, lag_s; with a fitted lag also rms and correlation as read; peak, its time
/// and the arrival of both; mean and impulse: of both over their common time, and its integral.
std::vector<StoredComparison> compare_all(const std::vector<DataComparison>& comparisons,
                                          const OwnSeries& own);

/// The numbers that every result has, in their order.
std::vector<std::string> comparison_numbers();

/// NaN: there is none.
double number_of(const StoredComparison& result, const std::string& name);
/// A text of a result: "file", the data with its whole path; "note", why there are no numbers.
/// Empty: there is none.
std::string text_of(const StoredComparison& result, const std::string& name);
inline std::string note_of(const StoredComparison& result) { return text_of(result, "note"); }

/// For people: a few lines each.
std::string comparisons_text(const std::vector<StoredComparison>& results);
/// An object by name: numbers (null: none), `unit`, `note`, data, column.
Json comparisons_json(const std::vector<StoredComparison>& results);

}  // namespace pbf::data_module
