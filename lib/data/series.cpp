#include "lib/data/series.h"

#include <fmt/core.h>
#include <algorithm>

#include "lib/base/error.h"

namespace pbf::data_module {
namespace {

struct CommonReadings {
  std::vector<double> own, reference;
  std::size_t times = 0, interpolated = 0;  ///< of the reference; without an own reading
  double low = HUGE_VAL, high = -HUGE_VAL;
};

/// Times are products of whole numbers and a step, which round differently.
double rounding(double t) { return 1e-9 * std::fabs(t); }

/// The first reading that is not before t, and whether it is at t.
struct NextReading {
  std::size_t index = 0;
  bool at = false;
};
NextReading next_reading(const TimeSeries& s, double t) {
  const auto next = std::ranges::lower_bound(s.time, t - rounding(t));
  return {std::size_t(next - s.time.begin()), next != s.time.end() && *next <= t + rounding(t)};
}

CommonReadings common_readings(const TimeSeries& own, const TimeSeries& reference,
                               const SeriesOptions& o) {
  CommonReadings out;
  for (std::size_t k = 0; k < reference.time.size(); ++k) {
    const double t = reference.time[k];
    if (t < o.from - rounding(o.from) || t > o.to + rounding(o.to)) continue;
    // At a step of a digitised curve there are several readings at one time.
    const double there = o.average > 0 ? mean_about(reference, t, o.average) : reference.value[k];
    if (!std::isfinite(there)) continue;
    ++out.times;
    out.low = std::min(out.low, there), out.high = std::max(out.high, there);
    const double here = mean_about(own, t + o.lag, o.average);
    if (!std::isfinite(here)) continue;
    if (!next_reading(own, t + o.lag).at) ++out.interpolated;
    out.own.push_back(here), out.reference.push_back(there);
  }
  return out;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

std::optional<double> correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = mean_of(a), mean_b = mean_of(b);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = a[k] - mean_a, y = b[k] - mean_b;
    aa += x * x, bb += y * y, ab += x * y;
  }
  if (!(aa > 0 && bb > 0)) return std::nullopt;
  return std::clamp(ab / (std::sqrt(aa) * std::sqrt(bb)), -1.0, 1.0);
}

SeriesDifference difference(const CommonReadings& both) {
  SeriesDifference out;
  out.points = both.own.size();
  out.interpolated = both.interpolated;
  double squares = 0;
  for (std::size_t k = 0; k < out.points; ++k) {
    const double e = both.own[k] - both.reference[k];
    squares += e * e;
    out.bias += e / double(out.points);
  }
  out.rms = std::sqrt(squares / double(out.points));
  out.range = both.high - both.low;
  if (out.range > 0) out.rms_relative = out.rms / out.range;
  out.correlation = correlation_of(both.own, both.reference);
  return out;
}

}  // namespace

double value_at(const TimeSeries& s, double t) {
  const auto [i, at] = next_reading(s, t);
  if (at) return s.value[i];
  if (i == 0 || i == s.time.size()) return NAN;
  const double part = (t - s.time[i - 1]) / (s.time[i] - s.time[i - 1]);
  return s.value[i - 1] + part * (s.value[i] - s.value[i - 1]);
}

Area area_under(const TimeSeries& s, double from, double to) {
  Area out;
  for (std::size_t i = std::max<std::size_t>(1, next_reading(s, from).index); i < s.time.size();
       ++i) {
    const double begin = s.time[i - 1], end = s.time[i];
    if (begin >= to) break;
    const double a = std::max(from, begin), b = std::min(to, end);
    if (!(b > a) || !std::isfinite(s.value[i])) continue;
    double mean = s.value[i];
    if (!s.means) {
      const double slope = (s.value[i] - s.value[i - 1]) / (end - begin);
      mean = s.value[i - 1] + slope * (0.5 * (a + b) - begin);
    }
    if (!std::isfinite(mean)) continue;
    out.integral += mean * (b - a);
    out.length += b - a;
  }
  return out;
}

double mean_about(const TimeSeries& s, double t, double window) {
  if (!(window > 0)) return value_at(s, t);
  const Area area = area_under(s, t - 0.5 * window, t + 0.5 * window);
  return area.length >= 0.5 * window * (1 - 1e-9) ? area.integral / area.length : NAN;
}

std::vector<double> averaged(const TimeSeries& s, double window) {
  std::vector<double> out(s.value.begin(), s.value.end());
  for (std::size_t k = 0; window > 0 && k < out.size(); ++k)
    out[k] = mean_about(s, s.time[k], window);
  return out;
}

CommonTimes common_times(const TimeSeries& own, const TimeSeries& reference,
                         const SeriesOptions& options) {
  const CommonReadings both = common_readings(own, reference, options);
  return {both.times, both.own.size()};
}

std::optional<SeriesDifference> difference_of(const TimeSeries& own, const TimeSeries& reference,
                                              const SeriesOptions& options) {
  const CommonReadings both = common_readings(own, reference, options);
  return enough_points(both.own.size(), both.times) ? std::optional(difference(both))
                                                    : std::nullopt;
}

SeriesDifference compare_series(const TimeSeries& own, const TimeSeries& reference,
                                const SeriesOptions& options) {
  const CommonReadings both = common_readings(own, reference, options);
  if (!enough_points(both.own.size(), both.times))
    throw Error(ExitCode::bad_input,
                fmt::format("{} of the reference's {} readings can be compared; at least {} and "
                            "half of them are needed",
                            both.own.size(), both.times, kFewestPoints));
  return difference(both);
}

}  // namespace pbf::data_module
