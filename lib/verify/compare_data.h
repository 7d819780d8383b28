// Compares two series of readings: a quantity of a run with that of a reference.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace pbf::verify_module {

/// Readings of one quantity; both lists have the same length. NaN: no reading at that time.
struct TimeSeries {
  std::span<const double> time;   ///< s, ascending
  std::span<const double> value;  ///< in the unit of the quantity
};

/// The value at time t (s), linear between two readings; that of a reading within 1e-9 of t
/// (relative). NaN before the first and after the last reading, and beside one that is missing.
double value_at(const TimeSeries& series, double t);

/// How `own` differs from `reference` at the times that both have.
struct SeriesDifference {
  double rms = 0;    ///< root of the mean square of own - reference, in their unit
  double bias = 0;   ///< mean of own - reference
  double range = 0;  ///< largest minus smallest reading of the reference
  std::optional<double> rms_relative;  ///< rms/range, 1; none for a reference that never changes
  std::optional<double> correlation;   ///< -1..1; none if one of the two never changes
  std::size_t points = 0;              ///< common times
  std::size_t interpolated = 0;        ///< of them, between two readings of `own`
};

/// Fewer points than this tell nothing about a difference over time.
inline constexpr std::size_t kFewestPoints = 10;

/// Whether so many common times of the `times` of a reference are enough: kFewestPoints, and half.
inline bool enough_points(std::size_t common, std::size_t times) {
  return common >= kFewestPoints && 2 * common >= times;
}

/// The number of times of the reference from `from` (s) on, and of those that `own` covers.
struct CommonTimes {
  std::size_t times = 0, common = 0;
};
CommonTimes common_times(const TimeSeries& own, const TimeSeries& reference, double from);

/// Compares at the times of the reference from `from` (s) on. Throws Error(bad_input), which gives
/// the numbers, where enough_points() says no.
SeriesDifference compare_series(const TimeSeries& own, const TimeSeries& reference,
                                double from = 0);

}  // namespace pbf::verify_module
