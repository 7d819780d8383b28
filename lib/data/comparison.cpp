#include "lib/data/comparison.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lib/base/error.h"
#include "lib/scene/number.h"

namespace pbf::data_module {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kArrival = 0.1;  // of the way from the first value to the peak

/// The window of the data's times.
SeriesOptions options_of(const Comparison& c) {
  SeriesOptions o;
  o.average = c.average;
  o.from = -HUGE_VAL;
  if (c.between) o.from = (*c.between)[0], o.to = (*c.between)[1];
  return o;
}

/// The numbers of a result in their order; `unit`: that of the reading.
std::vector<StoredComparison::Number> no_numbers(const std::string& unit) {
  const std::string integral = unit == "1"            ? "s"
                               : unit.ends_with("/s") ? unit.substr(0, unit.size() - 2)
                                                      : unit + " s";
  return {{"rms", unit, kNone},         {"rms_relative", "1", kNone},
          {"bias", unit, kNone},        {"correlation", "1", kNone},
          {"points", "1", kNone},       {"lag_s", "s", kNone},
          {"rms_as_read", unit, kNone}, {"correlation_as_read", "1", kNone},
          {"peak", unit, kNone},        {"peak_data", unit, kNone},
          {"peak_time_s", "s", kNone},  {"peak_time_data_s", "s", kNone},
          {"arrival_s", "s", kNone},    {"arrival_data_s", "s", kNone},
          {"mean", unit, kNone},        {"mean_data", unit, kNone},
          {"impulse", integral, kNone}, {"impulse_data", integral, kNone}};
}

class OneComparison {
 public:
  OneComparison(const DataComparison& c, QuantitySeries own)
      : c_(c), own_(std::move(own)), options_(options_of(c.entry)) {
    out_.name = name_of(c.entry);
    out_.numbers = no_numbers(c.own.site.unit);
    out_.texts = {{"reading", c.own.path},   {"data", c.entry.data},    {"file", c.data.file},
                  {"column", c.data.column}, {"sha256", c.data.sha256}, {"lag", c.entry.lag}};
  }

  /// The lag that was fitted; none: it could not be.
  std::optional<double> fit() {
    const Comparison::Span range = c_.entry.lag_range.value();
    const std::optional<LagFit> found =
        fit_lag(own(), c_.data.series(), options_, range[0], range[1]);
    if (!found) return std::nullopt;
    if (found->at_end)
      say(
          fmt::format("the fitted lag, {:.4g} s, is at the end of lag_range [{:.4g}, {:.4g}]: "
                      "widen it",
                      found->lag, range[0], range[1]));
    return found->lag;
  }

  StoredComparison compare(std::optional<double> lag, bool fitted) {
    if (!lag) return say("no lag could be fitted"), std::move(out_);
    try {
      if (fitted)
        if (const auto read = difference_of(own(), c_.data.series(), options_)) {
          set("rms_as_read", read->rms);
          set("correlation_as_read", read->correlation.value_or(kNone));
        }
      options_.lag = *lag;
      const SeriesDifference d = compare_series(own(), c_.data.series(), options_);
      set("rms", d.rms), set("rms_relative", d.rms_relative.value_or(kNone)), set("bias", d.bias);
      set("correlation", d.correlation.value_or(kNone)), set("points", double(d.points));
      set("lag_s", *lag);
      compare_events();
      compare_impulse();
    } catch (const Error& e) {
      if (e.code() != ExitCode::bad_input) throw;
      out_.numbers = no_numbers(c_.own.site.unit);
      say(e.what());
    }
    return std::move(out_);
  }

 private:
  TimeSeries own() const { return {own_.time, own_.value, c_.own.site.means}; }
  void set(const char* name, double value) {
    std::ranges::find(out_.numbers, name, &StoredComparison::Number::name)->value = value;
  }
  void say(const std::string& what) {
    for (auto& [name, text] : out_.texts)
      if (name == "note") return void(text += "; " + what);
    out_.texts.emplace_back("note", what);
  }

  /// The times that both have, of the data's clock.
  std::pair<double, double> common_span() const {
    const std::vector<double>&t = c_.data.time, &u = own_.time;
    if (t.empty() || u.empty()) return {0, 0};
    return {std::max({options_.from, t.front(), u.front() - options_.lag}),
            std::min({options_.to, t.back(), u.back() - options_.lag})};
  }

  void compare_events() {
    const auto [from, to] = common_span();
    const std::vector<double> there = averaged(c_.data.series(), options_.average),
                              here = averaged(own(), options_.average);
    const TimeSeries data{c_.data.time, there}, run{own_.time, here};
    const double high = events_of(data, from, to, 1, HUGE_VAL).peak,
                 low = events_of(data, from, to, -1, HUGE_VAL).peak;
    const int side = std::fabs(low) > std::fabs(high) ? -1 : 1;
    const double first = value_from(data, from), peak = side > 0 ? high : low;
    const double threshold = c_.entry.threshold.value_or(first + kArrival * (peak - first));
    const SeriesEvents of_data = events_of(data, from, to, side, threshold),
                       of_run =
                           events_of(run, from + options_.lag, to + options_.lag, side, threshold);
    set("peak", of_run.peak), set("peak_data", of_data.peak);
    set("peak_time_s", of_run.peak_time), set("peak_time_data_s", of_data.peak_time);
    set("arrival_s", of_run.arrival), set("arrival_data_s", of_data.arrival);
  }

  static double value_from(const TimeSeries& s, double from) {
    for (std::size_t k = 0; k < s.time.size(); ++k)
      if (s.time[k] >= from && std::isfinite(s.value[k])) return s.value[k];
    return kNone;
  }

  void compare_impulse() {
    const auto [from, to] = common_span();
    const Area here = area_under(own(), from + options_.lag, to + options_.lag),
               there = area_under(c_.data.series(), from, to);
    const double longer = std::max(here.length, there.length);
    if (std::fabs(here.length - there.length) > 0.01 * longer)
      return say("no mean and impulse, as one of the two has gaps");
    if (here.length > 0) set("impulse", here.integral), set("mean", here.integral / here.length);
    if (there.length > 0)
      set("impulse_data", there.integral), set("mean_data", there.integral / there.length);
  }

  const DataComparison& c_;
  QuantitySeries own_;
  SeriesOptions options_;
  StoredComparison out_;
};

/// The lag of an entry, as far as it is known before a run; of a fitted one the least.
double likely_lag(const Comparison& c, const std::vector<Comparison>& all) {
  double number = 0;
  if (c.lag_range) return std::clamp(0.0, (*c.lag_range)[0], (*c.lag_range)[1]);
  if (read_number(c.lag, number) == NumberError::none) return number;
  for (const Comparison& other : all)
    if (name_of(other) == c.lag && other.lag_range) return likely_lag(other, all);
  return 0;
}

}  // namespace

std::vector<DataComparison> read_comparisons(const std::vector<Comparison>& entries,
                                             const Readings& readings, double end,
                                             const std::string& folder) {
  std::vector<DataComparison> all;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Comparison& c = entries[k];
    const std::string place = c.place.text.empty() ? "" : c.place.text + ": ",
                      entry = by_options(c) ? c.place.text
                                            : place + "compare[" + std::to_string(k) + "]",
                      data = by_options(c) ? "--data" : entry + ".data";
    const Quantity own = quantity_of(c, readings, entry);
    all.push_back({c, own, read_measured(c, own, folder, data)});
    SeriesOptions o = options_of(c);
    const std::vector<double> whole{0, end}, zero{0, 0};
    o.lag = likely_lag(c, entries);
    const CommonTimes n = common_times({whole, zero}, all.back().data.series(), o);
    if (!enough_points(n.common, n.times))
      bad_input(data,
                fmt::format("{}: {} of its {} measured times lie within the run (0 to {:.6g} s); "
                            "at least {} and half of them are needed: give {}, another {} or a "
                            "longer run{}",
                            c.data, n.common, n.times, end, kFewestPoints,
                            by_options(c) ? "--between FROM,TO" : "between: [from, to]",
                            key_word(c, "time_scale"),
                            by_options(c) ? "" : ", or leave it out (compare: [])"));
  }
  return all;
}

std::vector<StoredComparison> compare_all(const std::vector<DataComparison>& comparisons,
                                          const OwnSeries& own) {
  std::vector<OneComparison> each;
  for (const DataComparison& c : comparisons) each.emplace_back(c, own(c.own));
  std::vector<std::pair<std::string, std::optional<double>>> fitted;
  for (std::size_t k = 0; k < each.size(); ++k)
    if (comparisons[k].entry.lag == "fit")
      fitted.emplace_back(name_of(comparisons[k].entry), each[k].fit());
  std::vector<StoredComparison> out;
  for (std::size_t k = 0; k < each.size(); ++k) {
    const Comparison& c = comparisons[k].entry;
    const std::string of = c.lag == "fit" ? name_of(c) : c.lag;
    const auto at =
        std::ranges::find(fitted, of, &std::pair<std::string, std::optional<double>>::first);
    double number = 0;
    if (at != fitted.end())
      out.push_back(each[k].compare(at->second, true));
    else
      out.push_back(
          each[k].compare(read_number(c.lag, number) == NumberError::none ? number : 0.0, false));
  }
  return out;
}

std::vector<std::string> comparison_numbers() {
  std::vector<std::string> names;
  for (const StoredComparison::Number& n : no_numbers("1")) names.push_back(n.name);
  return names;
}

double number_of(const StoredComparison& result, const std::string& name) {
  const auto at = std::ranges::find(result.numbers, name, &StoredComparison::Number::name);
  return at == result.numbers.end() ? kNone : at->value;
}

std::string text_of(const StoredComparison& result, const std::string& wanted) {
  for (const auto& [name, text] : result.texts)
    if (name == wanted) return text;
  return {};
}

}  // namespace pbf::data_module
