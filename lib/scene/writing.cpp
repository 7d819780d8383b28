#include "lib/scene/remedies.h"

#include <fmt/core.h>
#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "lib/base/plain_text.h"
#include "lib/base/text.h"
#include "lib/scene/number.h"

namespace pbf::scene_module {
namespace {

const char* const kDigits = "0123456789";

struct Unit {
  const char *written, *of;  ///< what was written, and the unit of our keys
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

/// "2 ms": 2 and "ms". Empty unless it is a number followed by letters.
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
  // 0x10, 0b1 and 0o7 are numbers of other languages, not units.
  if (!(std::isalpha(c) || c == '%' || c >= 0x80) || unit.size() > 12) return "";
  if (std::string("xXbBoO").find(unit[0]) != std::string::npos && unit.size() > 1 &&
      std::isdigit(static_cast<unsigned char>(unit[1])))
    return "";
  return unit;
}

/// Whether a key of "m or degrees" accepts the unit `one`.
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

}  // namespace

std::string number_remedy(const std::string& text, const std::string& unit) {
  double value = 0;
  if (const std::string comma = comma_remedy(text); !comma.empty()) return comma;
  if (const std::string other = unit_behind(text, value); !other.empty()) {
    const std::string in = unit.empty() || unit == "1" ? "" : ", the key is in " + unit;
    if (other == "Hz" && unit == "s" && value > 0)
      return fmt::format("; the key is a time in s, 1/frequency: {:.12g}", 1 / value);
    double factor = is_of(other, unit) ? 1 : 0;
    for (const Unit& u : kUnits)
      if (other == u.written && is_of(u.of, unit)) factor = u.factor;
    return "; write the number without a unit" + in +
           (factor > 0 ? fmt::format(": {:.12g}", value * factor) : "");
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

}  // namespace pbf::scene_module
