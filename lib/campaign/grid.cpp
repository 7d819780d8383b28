#include "lib/campaign/grid.h"

#include <fmt/core.h>
#include <cmath>

#include "lib/base/error.h"
#include "lib/scene/number.h"

namespace pbf::campaign_module {
std::string setting_text(const Node& value) {
  if (value.kind == Node::Kind::scalar) return value.text;
  if (value.kind == Node::Kind::null) return "off";
  const bool map = value.kind == Node::Kind::map;
  std::string out;
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (map) out += setting_text(value.keys[i]) + ": ";
    out += setting_text(value.items[i]);
  }
  return (map ? "{" : "[") + out + (map ? "}" : "]");
}

std::vector<std::string> override_texts(const Settings& settings) {
  std::vector<std::string> texts;
  for (const auto& [key, value] : settings) texts.push_back(key + "=" + setting_text(value));
  return texts;
}

GridAxis grid_axis(const std::string& key, const std::vector<std::string>& values) {
  GridAxis axis;
  for (const std::string& text : values) {
    Node value;
    value.kind = Node::Kind::scalar;
    value.text = text;
    axis.push_back({key + "=" + text, {{key, value}}});
  }
  return axis;
}

std::vector<GridMember> grid_members(const std::vector<GridAxis>& axes, std::size_t most,
                                     const std::string& where) {
  std::vector<GridMember> all(1);
  for (const GridAxis& axis : axes) {
    if (all.size() * axis.size() > most)
      bad_input(where, "makes more than " + std::to_string(most) + " runs");
    std::vector<GridMember> more;
    for (const GridMember& member : all)
      for (std::size_t k = 0; k < axis.size(); ++k) {
        GridMember& m = more.emplace_back(member);
        m.name += (m.name.empty() || axis[k].name.empty() ? "" : " ") + axis[k].name;
        m.settings.insert(m.settings.end(), axis[k].settings.begin(), axis[k].settings.end());
        m.at.push_back(k);
      }
    all = std::move(more);
  }
  return all;
}

std::vector<std::string> listed_values(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      values.emplace_back();
      continue;
    }
    values.back() += c;
  }
  return values;
}

std::vector<std::string> range_values(const std::string& where, const std::string& text) {
  double first = 0, last = 0;
  const std::size_t one = text.find(':');
  if (one == std::string::npos || read_number(text.substr(0, one), first) != NumberError::none)
    return {text};
  const std::size_t two = text.find(':', one + 1);
  std::int64_t count = 0;
  if (two == std::string::npos ||
      read_number(text.substr(one + 1, two - one - 1), last) != NumberError::none ||
      read_number(text.substr(two + 1), count) != NumberError::none || count < 2 || count > 1000 ||
      first == last)
    bad_input(where, "\"" + text +
                         "\" is no range FIRST:LAST:COUNT of two different numbers and 2 to 1000 "
                         "values, e.g. 0.02:0.04:5");
  std::vector<std::string> values;
  for (std::int64_t k = 0; k < count; ++k) {
    const double part = double(k) / double(count - 1);
    values.push_back(fmt::format("{:.15g}", first * (1 - part) + last * part));
  }
  return values;
}

std::vector<double> numbers_listed(const std::string& key, const std::string& text, bool whole) {
  const std::string where = "values of " + key;
  const auto number = [&](const std::string& word) {
    double v = 0;
    if (const NumberError e = read_number(word, v); e != NumberError::none)
      bad_input(where, "\"" + word + "\" " + describe(e));
    return v;
  };
  std::vector<double> values;
  const std::size_t first = text.find(':'), last = text.rfind(':');
  if (first == std::string::npos) {
    for (const std::string& word : listed_values(text)) {
      values.push_back(number(word));
      if (whole && values.back() != std::floor(values.back()))
        bad_input(where, word + " " + describe(NumberError::not_whole));
    }
    return values;
  }
  if (first == last || text.find(':', first + 1) != last)
    bad_input(where, "expected V1,V2,... or FIRST:LAST:COUNT");
  const double low = number(text.substr(0, first)),
               high = number(text.substr(first + 1, last - first - 1)),
               count = number(text.substr(last + 1));
  if (!(low > 0 && high > low && count >= 2 && count <= 1000 && count == std::floor(count)))
    bad_input(where, text + " is no range with 0 < FIRST < LAST and 2 to 1000 values");
  for (int k = 0; k < int(count); ++k) {
    const double v = low * std::pow(high / low, k / (count - 1));
    if (!whole)
      values.push_back(v);
    else if (values.empty() || values.back() != std::round(v))
      values.push_back(std::round(v));
  }
  return values;
}

}  // namespace pbf::campaign_module
