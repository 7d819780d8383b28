// What gauges and loads of a run were like, in a few numbers: columns of a batch's summary.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/scene/summary.h"

namespace pbf::data_module {

/// Of the means over 20 ms.
inline constexpr double kLoadWindow = 0.02;  // s

/// The largest mean of a force over a window (s), by size and with its sign, N; from its impulse
/// (N s) at times (s), of which only those from `from` (s) on count. A window begins or ends at one
/// of them, and between two of them the force is taken as constant. NaN where they are farther
/// apart than the window, or span less than it.
double window_peak(std::span<const double> time, std::span<const double> impulse, double from,
                   double window);

/// The numbers of columns in a run, in their order. NaN: the run has no such readings, or too few.
/// from: s, readings before it do not count.
std::vector<double> summary_numbers(const RunReader& file,
                                    const std::vector<SummaryColumn>& columns, double from);

}  // namespace pbf::data_module
