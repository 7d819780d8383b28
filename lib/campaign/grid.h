// Axes of values and all their combinations: the grid of a batch, a study, a stability map and a
// benchmark.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lib/scene/yaml_tree.h"

namespace pbf::inline campaign_module {

/// Keys of the scene with one value each.
using Settings = std::vector<std::pair<std::string, Node>>;

/// A value as it was written, on one line.
std::string setting_text(const Node& value);
/// "key=value" of each, as --set takes them.
std::vector<std::string> override_texts(const Settings& settings);

/// What an axis goes through: settings that come together, and their name among people.
struct GridStep {
  std::string name;
  Settings settings;
};
using GridAxis = std::vector<GridStep>;

/// A key and its values as they were written, one per step, each named "key=value".
GridAxis grid_axis(const std::string& key, const std::vector<std::string>& values);
/// The same of whole numbers.
template <class T>
GridAxis grid_axis(const std::string& key, const std::vector<T>& values) {
  std::vector<std::string> texts;
  for (const T v : values) texts.push_back(std::to_string(v));
  return grid_axis(key, texts);
}

/// One member of a grid.
struct GridMember {
  std::string name;  ///< of its steps, with blanks between
  Settings settings;
  std::vector<std::size_t> at;  ///< the step of each axis
};

/// Every combination of the axes' steps, the last axis fastest; one member without axes. Throws
/// Error(bad_input), "where: makes more than MOST runs".
std::vector<GridMember> grid_members(const std::vector<GridAxis>& axes, std::size_t most,
                                     const std::string& where);

/// Values of "a,b,c": commas inside [], {} and quotes do not separate.
std::vector<std::string> listed_values(const std::string& text);

/// Of one value as it was written: FIRST:LAST:COUNT becomes its numbers in equal steps, both ends
/// included, with at most 15 digits; anything else stays. Throws Error(bad_input), "WHERE: ...",
/// for what begins like a range and is none.
std::vector<std::string> range_values(const std::string& where, const std::string& text);

/// Numbers of "V1,V2,..." or FIRST:LAST:COUNT (in equal ratios), rounded or required to be whole
/// where `whole`. Throws Error(bad_input), "values of KEY: ...".
std::vector<double> numbers_listed(const std::string& key, const std::string& text, bool whole);

}  // namespace pbf::inline campaign_module
