#include "lib/scene/writing.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "lib/base/plain_text.h"
#include "lib/base/text.h"
#include "lib/scene/number.h"

namespace pbf::inline scene_module {
namespace {

const char* const kDigits = "0123456789";

struct Unit {
  const char *written, *of;  ///< the unit that keys have instead
  double factor;
};
constexpr Unit kUnits[] = {
    {"ms", "s", 1e-3},
    {"us", "s", 1e-6},
    {"min", "s", 60},
    {"h", "s", 3600},
    {"mm", "m", 1e-3},
    {"cm", "m", 1e-2},
    {"dm", "m", 0.1},
    {"km", "m", 1e3},
    {"g", "kg", 1e-3},
    {"t", "kg", 1e3},
    {"g/cm^3", "kg/m^3", 1e3},
    {"g/cm3", "kg/m^3", 1e3},
    {"cm/s", "m/s", 1e-2},
    {"%", "", 1e-2},
    {"km/h", "m/s", 1 / 3.6},
    {"sec", "s", 1},
    {"seconds", "s", 1},
    {"m/s2", "m/s^2", 1},
    {"m/s\u00b2", "m/s^2", 1},
    {"m/s**2", "m/s^2", 1},
    {"cm/s^2", "m/s^2", 1e-2},
    {"g", "m/s^2", 9.80665},
    {"kg/m3", "kg/m^3", 1},
    {"kg/m\u00b3", "kg/m^3", 1},
    {"g/l", "kg/m^3", 1},
    {"deg", "degrees", 1},
    {"degree", "degrees", 1},
    {"\u00b0", "degrees", 1},
    {"rad", "degrees", 57.29577951308232},
    {"deg/s", "degrees/s", 1},
    {"rad/s", "degrees/s", 57.29577951308232},
    {"rpm", "degrees/s", 6},
};

bool is_number(const std::string& text, double& value) {
  return read_number(text, value) == NumberError::none;
}

/// "2 ms": 2 and "ms". Empty where it is no number with letters behind it.
std::string unit_behind(const std::string& text, double& value) {
  std::size_t at = text.find_first_not_of("+-.0123456789");
  // 1e-3m: the exponent belongs to the number.
  if (at != text.npos && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t end = at + 1;
    if (end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
    const std::size_t behind = std::min(text.find_first_not_of(kDigits, end), text.size());
    if (behind > end) at = behind;
  }
  if (at == text.npos || at >= text.size() || !is_number(text.substr(0, at), value)) return "";
  const std::size_t begin = text.find_first_not_of(' ', at);
  if (begin == text.npos) return "";
  const std::string unit = text.substr(begin);
  const auto c = static_cast<unsigned char>(unit[0]);
  // 0x10, 0b1 and 0o7 are numbers of other languages; a unit has at most an exponent as a digit.
  if (!(std::isalpha(c) || c == '%' || c >= 0x80) || unit.size() > 12) return "";
  if (std::string("xXbBoO").find(unit[0]) != std::string::npos && unit.size() > 1 &&
      std::isdigit(static_cast<unsigned char>(unit[1])))
    return "";
  return unit;
}

/// Whether a key of "m or degrees" takes such a number.
bool is_of(const std::string& one, const std::string& unit) {
  const std::size_t rest = unit.find(" or ");
  return one == unit ||
         (rest != unit.npos && (one == unit.substr(0, rest) || one == unit.substr(rest + 4)));
}

std::string without(std::string text, const std::string& characters) {
  std::erase_if(text, [&](char c) { return characters.find(c) != characters.npos; });
  return text;
}

std::string comma_remedy(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == text.npos || comma == 0 || comma + 1 == text.size()) return "";
  if (std::count(text.begin(), text.end(), ',') > 1) return "";
  std::string point = text;
  point[comma] = '.';
  double value = 0;
  if (!is_number(point, value)) return "";
  const bool thousands = text.size() - comma == 4 && text[0] != '0';
  return "; decimals take a point: write " + point +
         (thousands ? ", or " + without(text, ",") + " if thousands were meant" : "");
}

/// A line of a file: its indentation and what stands there.
struct Line {
  std::size_t indent;
  std::string text;  ///< without the comment and blanks around it
  int number;        ///< from 0
};

/// Lines of blocks: without empty ones, and those within brackets that opened before.
std::vector<Line> block_lines(const std::string& text, int last) {
  std::vector<Line> lines;
  int depth = 0, number = 0;
  for (std::size_t start = 0; start < text.size() && number <= last; ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string line = text.substr(start, end - start);
    start = end + 1;
    char quote = 0;
    int opened = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '#' && (i == 0 || line[i - 1] == ' ')) {
        line.resize(i);
      } else if (c == '\'' || c == '"') {
        quote = c;
      } else {
        opened += (c == '[' || c == '{') - (c == ']' || c == '}');
      }
    }
    const std::size_t first = line.find_first_not_of(" \r");
    if (first != line.npos && depth == 0)
      lines.push_back(
          {first, line.substr(first, line.find_last_not_of(" \r") + 1 - first), number});
    depth = std::max(0, depth + opened);
  }
  return lines;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }

/// "step: 0.002": a key that has its value on its line.
bool has_value(const std::string& line) {
  const std::size_t colon = line.find(": ");
  return colon != line.npos && is_letter(line[0]) && line.find_first_of("\"'{[") > colon;
}
bool is_key(const std::string& line) {
  return is_letter(line[0]) && (has_value(line) || line.back() == ':');
}

std::string indentation_remedy(const std::vector<Line>& lines) {
  std::vector<std::size_t> levels;  // of the lines around
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    const std::string place = "line " + std::to_string(line.number + 1);
    while (!levels.empty() && levels.back() > line.indent) levels.pop_back();
    if (i > 0 && line.indent > lines[i - 1].indent && is_key(line.text) &&
        has_value(lines[i - 1].text))
      return "; " + place +
             " is indented deeper than the line before it, which has a value of its "
             "own: keys of one block begin in the same column";
    if (i > 0 && line.indent < lines[i - 1].indent &&
        (levels.empty() || levels.back() != line.indent))
      return "; " + place +
             " is indented like no line above it: keys of one block begin in the "
             "same column";
    if (levels.empty() || levels.back() < line.indent) levels.push_back(line.indent);
    // What follows a dash begins a block of its own.
    if (line.text.size() > 2 && line.text[0] == '-' && line.text[1] == ' ')
      levels.push_back(line.indent + line.text.find_first_not_of(' ', 1));
  }
  return "";
}

}  // namespace

std::string number_remedy(const std::string& text, const std::string& unit) {
  double value = 0;
  if (const std::string comma = comma_remedy(text); !comma.empty()) return comma;
  if (const std::string other = unit_behind(text, value); !other.empty()) {
    const std::string in = unit.empty() || unit == "1" ? "" : ", the key is in " + unit;
    if (other == "Hz" && unit == "s" && value > 0)
      return "; the key is a time in s, 1/frequency: " + format("%.12g", 1 / value);
    double factor = is_of(other, unit) ? 1 : 0;
    for (const Unit& u : kUnits)
      if (other == u.written && is_of(u.of, unit)) factor = u.factor;
    return "; write the number without a unit" + in +
           (factor > 0 ? ": " + format("%.12g", value * factor) : "");
  }
  const std::string digits = without(text, "_' ");
  if (digits != text && text.find_first_not_of("+-.0123456789_' ") == text.npos &&
      is_number(digits, value))
    return "; write it in one piece: " + digits;
  if (text.find_first_not_of("+-.0123456789eE*/() ") == text.npos &&
      text.find_first_of("*/") != text.npos)
    return "; formulas are not computed: write the result";
  return "";
}

std::string axis_remedy(const std::string& text) {
  const bool back = !text.empty() && text[0] == '-';
  const std::string axis = text.substr(back || text.starts_with('+') ? 1 : 0);
  if (axis.size() != 1 || std::string("xyzXYZ").find(axis) == std::string::npos) return "";
  std::string list;
  for (const char c : {'x', 'y', 'z'})
    list += (list.empty() ? "" : ", ") +
            std::string(std::tolower(static_cast<unsigned char>(axis[0])) != c ? "0"
                        : back                                                 ? "-1"
                                                                               : "1");
  return "; write [" + list + "]";
}

std::string list_remedy(const std::string& text, std::size_t numbers) {
  std::string words = text;
  std::replace_if(
      words.begin(), words.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  words = without(words, "()");
  std::istringstream in(words);
  std::vector<std::string> all;
  double value = 0;
  for (std::string word; in >> word; all.push_back(word))
    if (!is_number(word, value)) return "";
  return all.size() == numbers ? "; write [" + joined(all, ", ") + "]" : "";
}

std::string missing_space(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos || colon == 0 || colon + 1 >= text.size() || !is_letter(text[0]) ||
      text[colon + 1] == ' ' || text[colon + 1] == '/')
    return "";
  const std::string key = text.substr(0, colon);
  if (!std::all_of(key.begin(), key.end(), [](char c) {
        return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) || c == '.';
      }))
    return "";
  return "; a space is missing behind \"" + one_line(key, 40) + ":\"";
}

std::string layout_remedy(const std::string& text, int line) {
  const std::vector<Line> lines = block_lines(text, line);
  // YAML complains of the line behind, for a text may go on there.
  for (std::size_t back = 0; back < std::min<std::size_t>(2, lines.size()); ++back) {
    const Line& l = lines[lines.size() - 1 - back];
    const std::size_t dash = l.text.rfind("- ", 0) == 0 ? l.text.find_first_not_of(' ', 1) : 0;
    if (const std::string found = missing_space(l.text.substr(dash)); !found.empty())
      return found + " on line " + std::to_string(l.number + 1);
  }
  return indentation_remedy(lines);
}

}  // namespace pbf::inline scene_module
