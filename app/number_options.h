// Numbers on the command line, read as in scenes: "1e3" is 1000, "010" ten, "1.5" no whole number.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "lib/scene/number.h"

namespace pbf::inline app_module {

/// For Option::transform: a whole number from `low` to `high`, handed on in plain digits.
inline CLI::Validator whole_number(std::int64_t low,
                                   std::int64_t high = std::numeric_limits<int>::max()) {
  const std::string range = std::to_string(low) + " to " + std::to_string(high);
  return CLI::Validator(
      [low, high, range](std::string& text) -> std::string {
        std::int64_t v = 0;
        if (const NumberError e = read_integer(text, v); e != NumberError::none)
          return "\"" + text + "\" " + describe(e) + "; give a whole number from " + range;
        if (v < low || v > high) return text + " is out of range, " + range;
        text = std::to_string(v);
        return "";
      },
      range);
}

/// For Option::transform: a number not below `low`, or above it, in `unit`.
inline CLI::Validator number_from(double low, bool above, const std::string& unit) {
  const std::string what = "a number" + (unit.empty() ? unit : " of " + unit) +
                           (above ? " above " : " from ") + to_text(low) + (above ? "" : " on");
  return CLI::Validator(
      [low, above, what](std::string& text) -> std::string {
        double v = 0;
        if (const NumberError e = read_double(text, v); e != NumberError::none)
          return "\"" + text + "\" " + describe(e) + "; give " + what;
        return v < low || (above && v <= low) ? text + " is not " + what : std::string();
      },
      what);
}

}  // namespace pbf::inline app_module
