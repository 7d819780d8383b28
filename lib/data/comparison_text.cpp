// Results of comparisons for people and as JSON.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "lib/data/comparison.h"

namespace pbf::data_module {
namespace {

std::string unit_of(const StoredComparison& r, const char* number) {
  const auto at = std::ranges::find(r.numbers, number, &StoredComparison::Number::name);
  const std::string unit = at == r.numbers.end() ? "1" : at->unit;
  return unit == "1" ? "" : " " + unit;
}

/// "-" for a number that there is not.
std::string number_text(double x, const char* form = "{:.4g}") {
  return std::isnan(x) ? "-" : fmt::format(fmt::runtime(form), x);
}

/// "0.12 m (data 0.13)", or "-" where there is none.
std::string both(const StoredComparison& r, const char* run, const char* data) {
  const double a = number_of(r, run), b = number_of(r, data);
  return number_text(a) + unit_of(r, run) + " (data " + number_text(b) + ")";
}

std::string lag_text(const StoredComparison& r) {
  const double lag = number_of(r, "lag_s"), read = number_of(r, "rms_as_read");
  if (text_of(r, "lag") == "fit" && std::isnan(read))
    return fmt::format("lag {:.4g} s, fitted", lag);
  if (!std::isnan(read))
    return fmt::format("lag {:.4g} s, fitted; as read RMS {:.4g}{}, correlation {}", lag, read,
                       unit_of(r, "rms"),
                       number_text(number_of(r, "correlation_as_read"), "{:.3f}"));
  return lag == 0 ? "no lag" : fmt::format("lag {:.4g} s, given", lag);
}

}  // namespace

std::string comparisons_text(const std::vector<StoredComparison>& results) {
  std::string out;
  for (const StoredComparison& r : results) {
    const std::string note = note_of(r);
    const double rms = number_of(r, "rms"), relative = number_of(r, "rms_relative");
    out += fmt::format("  {:17} ", r.name);
    if (std::isnan(rms)) {
      out += "not compared: " + note + "\n";
      continue;
    }
    out += fmt::format(
        "RMS {:.4g}{}{}, correlation {}, bias {:+.4g}{}, {:.0f} points, {}\n", rms,
        unit_of(r, "rms"),
        std::isnan(relative) ? "" : fmt::format(" ({:.3g} % of the data's range)", 100 * relative),
        number_text(number_of(r, "correlation"), "{:.3f}"), number_of(r, "bias"),
        unit_of(r, "bias"), number_of(r, "points"), lag_text(r));
    out += fmt::format("  {:17} peak {} at {}; arrival {}; mean {}; impulse {}\n", "",
                       both(r, "peak", "peak_data"), both(r, "peak_time_s", "peak_time_data_s"),
                       both(r, "arrival_s", "arrival_data_s"), both(r, "mean", "mean_data"),
                       both(r, "impulse", "impulse_data"));
    if (!note.empty()) out += fmt::format("  {:17} {}\n", "", note);
  }
  return out;
}

Json comparisons_json(const std::vector<StoredComparison>& results) {
  Json all = Json::object();
  for (const StoredComparison& r : results) {
    Json& one = all[r.name];
    for (const StoredComparison::Number& n : r.numbers)
      one[n.name] = std::isnan(n.value) ? Json() : Json(n.value);
    if (!r.numbers.empty()) one["unit"] = r.numbers[0].unit;
    for (const auto& [name, text] : r.texts)
      if (name != "sha256" && name != "file") one[name] = text;
  }
  return all;
}

}  // namespace pbf::data_module
