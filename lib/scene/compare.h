// What a scene compares its readings with, as plain data: measurements, or a reference run. Reading
// and comparing: lib/data.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lib/scene/motion.h"

namespace pbf::scene_module {

/// A reading of the run beside a series of a file. One of gauge, load and log says which reading.
struct Comparison {
  using Span = std::array<double, 2>;
  std::string name;  ///< of the result; empty: name_of()
  std::string gauge, load, log;
  std::string component;             ///< x, y, z of a velocity; of a load force_x ..., or x, y, z
  std::string data;                  ///< CSV table, or another run
  Place place{};                     ///< of the path
  std::string column;                ///< of the data; empty: as the reading is named
  std::string time_column;           ///< its column of times; empty: the first named t or time
  std::optional<double> time_scale;  ///< s of one unit of it; absent: from its name
  std::optional<double> scale;       ///< value = scale column + offset; absent: from its name
  double offset = 0;                 ///< in the unit of the reading
  double average = 0;                ///< s, window over which both are averaged; 0: none
  std::optional<Span> between{};     ///< s, of the data's time, [from, to]; absent: all
  std::string lag = "none";          ///< none, fit, a number (s) or the name of one that is fitted
  std::optional<Span> lag_range{};   ///< s, [least, largest] of fit
  std::optional<double> threshold;   ///< of the arrival; absent: a tenth of the way to the peak
  bool operator==(const Comparison&) const = default;
};

/// Its name, or "H2", "U_x", "post_x", "front_x".
inline std::string name_of(const Comparison& c) {
  if (!c.name.empty()) return c.name;
  std::string name = c.gauge + c.load + c.log;
  if (!c.component.empty()) name += "_" + c.component;
  for (char& letter : name)
    if (letter == '/') letter = '_';
  return name;
}

/// What is wrong with an entry whatever the scene is: the key, and what with its remedy.
struct ComparisonProblem {
  std::string key, what;
};
std::optional<ComparisonProblem> problem_of(const Comparison& entry,
                                            const std::vector<Comparison>& all);

}  // namespace pbf::scene_module
