// The lag between two series, and what stands out in one.
#include <algorithm>

#include "lib/base/error.h"
#include "lib/data/series.h"

namespace pbf::data_module {
namespace {

constexpr double kMostWork = 2e7;  // readings times lags of one pass

/// The middle one of the intervals between readings, s.
double usual_interval(const TimeSeries& s) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < s.time.size(); ++k) steps.push_back(s.time[k] - s.time[k - 1]);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

class LagSearch {
 public:
  LagSearch(const TimeSeries& own, const TimeSeries& reference, SeriesOptions options)
      : own_(own), reference_(reference), o_(options) {}

  /// -2, less than any correlation, where nothing can be compared.
  double correlation(double lag) const {
    SeriesOptions o = o_;
    o.lag = lag;
    const std::optional<SeriesDifference> d = difference_of(own_, reference_, o);
    return d ? d->correlation.value_or(-2) : -2;
  }
  /// Tries low, low + step ... high.
  void try_all(double low, double high, double step) {
    const auto n = std::max<std::int64_t>(1, std::int64_t(std::ceil((high - low) / step - 1e-9)));
    for (std::int64_t k = 0; k <= n; ++k) take(std::min(high, low + double(k) * step));
  }
  void take(double lag) {
    if (const double c = correlation(lag); c > most_ + 1e-12) most_ = c, best_ = lag;
  }
  double best() const { return best_; }
  double most() const { return most_; }

 private:
  const TimeSeries &own_, &reference_;
  SeriesOptions o_;
  double best_ = 0, most_ = -2;
};

}  // namespace

std::optional<LagFit> fit_lag(const TimeSeries& own, const TimeSeries& reference,
                              const SeriesOptions& options, double low, double high) {
  const double fine = usual_interval(own);
  if (!(fine > 0)) return std::nullopt;
  const double window = 1 + (options.average > 0 ? options.average / fine : 0);  // readings
  const double lags = kMostWork / window / double(std::max<std::size_t>(1, reference.time.size()));
  double step = std::max(fine, (high - low) / lags);
  LagSearch search(own, reference, options);
  // Whole readings from lag 0 on, so that a shifted copy is found exactly.
  const double first = step * std::ceil(low / step - 1e-9);
  search.take(low), search.take(high);
  if (first <= high) search.try_all(first, first + step * std::floor((high - first) / step), step);
  if (search.most() <= -2) return std::nullopt;
  for (; step > fine; step = std::max(fine, step / 8)) {
    const double next = std::max(fine, step / 8), at = search.best();
    search.try_all(std::max(low, at - step), std::min(high, at + step), next);
  }
  const double at = search.best(), c = search.most();
  if (at - step >= low && at + step <= high) {  // the vertex of the parabola through three lags
    const double before = search.correlation(at - step), after = search.correlation(at + step);
    const double bend = before - 2 * c + after;
    if (before > -2 && after > -2 && bend < 0)
      search.take(at + 0.5 * step * (before - after) / bend);
  }
  const double lag = search.best();
  return LagFit{lag, lag <= low + 0.5 * fine || lag >= high - 0.5 * fine};
}

SeriesEvents events_of(const TimeSeries& s, double from, double to, int side, double threshold) {
  SeriesEvents out;
  // Times and values of a copy may differ in their last bits.
  const double slack = 1e-9 * std::max(std::fabs(from), std::fabs(to));
  const double reached = side * threshold - 1e-9 * std::fabs(threshold);
  double before = NAN, at = NAN;
  for (std::size_t k = 0; k < s.time.size(); ++k) {
    const double t = s.time[k], v = side * s.value[k];
    if (t < from - slack || t > to + slack || !std::isfinite(v)) continue;
    if (!(side * out.peak >= v)) out.peak = side * v, out.peak_time = t;
    if (std::isnan(out.arrival) && v >= reached) {
      const double part = v > before ? (reached - before) / (v - before) : 1;
      out.arrival = std::isnan(before) ? t : at + part * (t - at);
    }
    before = v, at = t;
  }
  return out;
}

}  // namespace pbf::data_module
