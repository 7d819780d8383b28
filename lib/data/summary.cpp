#include "lib/data/summary.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lib/data/quantity.h"
#include "lib/data/series.h"

namespace pbf::data_module {
namespace {

/// Times are products of whole numbers and a step.
constexpr double kSlack = 1e-9;

/// The largest reading that says nothing about the time before `from`.
double largest_reading(const TimeSeries& s, double from) {
  const double first = from - kSlack * std::fabs(from);
  double most = NAN;
  for (std::size_t k = s.means ? 1 : 0; k < s.time.size(); ++k)
    if (s.time[s.means ? k - 1 : k] >= first && !(most >= s.value[k])) most = s.value[k];
  return most;
}

double number_of(const TimeSeries& s, SummaryOf of, double from) {
  if (s.time.empty()) return NAN;
  if (of == SummaryOf::largest) return largest_reading(s, from);
  if (of == SummaryOf::window_peak) return window_peak(s.time, s.value, from, kLoadWindow);
  const double begin = std::max(from, s.time.front()), end = s.time.back();
  if (of == SummaryOf::mean) {
    const Area area = area_under(s, begin, end);
    return area.length > 0 ? area.integral / area.length : NAN;
  }
  if (!(end > begin)) return NAN;
  const double change = value_at(s, end) - value_at(s, begin);
  return of == SummaryOf::change ? change : change / (end - begin);
}

}  // namespace

double window_peak(std::span<const double> time, std::span<const double> impulse, double from,
                   double window) {
  if (time.empty()) return NAN;
  const TimeSeries s{time, impulse};
  const double first = std::max(from, time.front()), last = time.back(), slack = kSlack * window;
  std::vector<double> begins{first};
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] < first) continue;
    if (k > 0 && time[k] > first && time[k] - time[k - 1] > window + slack) return NAN;
    begins.push_back(time[k]), begins.push_back(time[k] - window);
  }
  double most = NAN;
  for (const double begin : begins) {
    if (begin < first - slack || begin + window > last + slack) continue;
    const double a = std::max(begin, first), b = std::min(begin + window, last);
    const double force = (value_at(s, b) - value_at(s, a)) / (b - a);
    if (std::isfinite(force) && !(std::fabs(most) >= std::fabs(force))) most = force;
  }
  return most;
}

std::vector<double> summary_numbers(const RunReader& file,
                                    const std::vector<SummaryColumn>& columns, double from) {
  std::map<std::string, RunColumn> read;
  const auto column = [&](const std::string& path) -> const RunColumn& {
    const auto [at, fresh] = read.try_emplace(path);
    if (fresh) at->second = file.column(path);
    return at->second;
  };
  std::vector<double> numbers;
  for (const SummaryColumn& c : columns) {
    const QuantitySeries s = series_of(column(c.path), column(time_path(c.path)),
                                       {c.path, c.component, {c.unit, 1, c.means}, {}});
    numbers.push_back(number_of({s.time, s.value, c.means}, c.of, from));
  }
  return numbers;
}

}  // namespace pbf::data_module
