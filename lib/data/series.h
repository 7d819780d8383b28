// Compares two series of readings: a quantity of a run with a measured one, or with that of a
// reference run.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace pbf::data_module {

/// Readings of one quantity; both lists have the same length. NaN: no reading at that time.
struct TimeSeries {
  std::span<const double> time;   ///< s, ascending
  std::span<const double> value;  ///< in the unit of the quantity
  /// Each value is the mean since the reading before it, as loads and flows are.
  bool means = false;
};

/// The value at time t (s), linear between two readings; that of a reading within 1e-9 of t
/// (relative). NaN before the first and after the last reading, and beside one that is missing.
double value_at(const TimeSeries& series, double t);

/// The integral (unit times s) and the length (s) of the part of [from, to] that has readings:
/// under the line through them, or of the means. Nothing beside a missing reading.
struct Area {
  double integral = 0, length = 0;
};
Area area_under(const TimeSeries& series, double from, double to);

/// The mean over a window of length `window` (s) about t; NaN where less than half of it has
/// readings. With a window of 0: value_at().
double mean_about(const TimeSeries& series, double t, double window);

/// The readings with mean_about() in place of each value.
std::vector<double> averaged(const TimeSeries& series, double window);

/// Which readings of the reference are compared, and with what.
struct SeriesOptions {
  double from = 0, to = HUGE_VAL;  ///< s, of the reference
  double average = 0;              ///< s, window over which both are averaged; 0: none
  double lag = 0;                  ///< s, by which `own` is late: own(t + lag) against reference(t)
};

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

/// The number of times of the reference that count, and of those that `own` covers.
struct CommonTimes {
  std::size_t times = 0, common = 0;
};
CommonTimes common_times(const TimeSeries& own, const TimeSeries& reference,
                         const SeriesOptions& options = {});

/// Compares at the times of the reference; none where enough_points() says no.
std::optional<SeriesDifference> difference_of(const TimeSeries& own, const TimeSeries& reference,
                                              const SeriesOptions& options = {});
/// The same. Throws Error(bad_input), which gives the numbers, where
/// enough_points() says no.
SeriesDifference compare_series(const TimeSeries& own, const TimeSeries& reference,
                                const SeriesOptions& options = {});

/// The lag (s) from `low` to `high` with the largest correlation, to a reading of `own` or better.
struct LagFit {
  double lag = 0;
  bool at_end = false;  ///< of the range: the best one may lie beyond
};
/// Lags with which compare_series() would refuse are passed over; none: no lag is left, or one of
/// the two never changes.
std::optional<LagFit> fit_lag(const TimeSeries& own, const TimeSeries& reference,
                              const SeriesOptions& options, double low, double high);

/// What stands out in a series from `from` to `to` (s); NaN: there is none.
struct SeriesEvents {
  double peak = NAN, peak_time = NAN;  ///< the largest value times `side`; when, s
  double arrival = NAN;  ///< s, when side * value first reaches side * threshold, linear between
};
SeriesEvents events_of(const TimeSeries& series, double from, double to, int side,
                       double threshold);

}  // namespace pbf::data_module
