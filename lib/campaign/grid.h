// Axes of values and all their combinations: grids of batches, studies, stability maps and
// benchmarks.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lib/scene/yaml_tree.h"

namespace pbf::campaign_module {

/// Keys of the scene with one value each.
using Settings = std::vector<std::pair<std::string, Node>>;

/// The text of a value, on one line.
std::string setting_text(const Node& value);
/// "key=value" for each setting, in the form of --set.
std::vector<std::string> override_texts(const Settings& settings);

/// One step of an axis: settings that change together, and their name for users.
struct GridStep {
  std::string name;
  Settings settings;
};
using GridAxis = std::vector<GridStep>;

/// An axis of one key: one step per value, each named "key=value".
GridAxis grid_axis(const std::string& key, const std::vector<std::string>& values);
/// The same for whole numbers.
template <class T>
GridAxis grid_axis(const std::string& key, const std::vector<T>& values) {
  std::vector<std::string> texts;
  for (const T v : values) texts.push_back(std::to_string(v));
  return grid_axis(key, texts);
}

/// One member of a grid.
struct GridMember {
  std::string name;  ///< names of its steps, separated by blanks
  Settings settings;
  std::vector<std::size_t> at;  ///< index of the step on each axis
};

/// All combinations of the axes' steps, the last axis fastest; one member without axes. Throws
/// Error(bad_input), "where: makes more than MOST runs".
std::vector<GridMember> grid_members(const std::vector<GridAxis>& axes, std::size_t most,
                                     const std::string& where);

/// Values of "a,b,c"; commas inside [], {} and quotes are not separators.
std::vector<std::string> listed_values(const std::string& text);

/// Expands FIRST:LAST:COUNT to equidistant numbers with both ends, with at most 15 digits; other
/// values are returned unchanged. Throws Error(bad_input), "WHERE: ...", for an invalid range.
std::vector<std::string> range_values(const std::string& where, const std::string& text);

/// Numbers of "V1,V2,..." or FIRST:LAST:COUNT (a geometric sequence). `whole`: the former must be
/// whole, the latter are rounded. Throws Error(bad_input), "values of KEY: ...".
std::vector<double> numbers_listed(const std::string& key, const std::string& text, bool whole);

}  // namespace pbf::campaign_module
