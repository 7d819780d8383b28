#include "lib/scene/number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "lib/base/text.h"

namespace pbf::inline scene_module {
namespace {

/// Whether `s` is a decimal number; `whole` tells whether it has digits (and a sign) only.
bool is_decimal(const std::string& s, bool& whole) {
  const auto is_digit = [&s](std::size_t k) { return k < s.size() && s[k] >= '0' && s[k] <= '9'; };
  std::size_t k = !s.empty() && (s[0] == '+' || s[0] == '-') ? 1 : 0;
  const std::size_t first = k;
  while (is_digit(k)) ++k;
  std::size_t digits = k - first;
  whole = k == s.size();
  if (k < s.size() && s[k] == '.') {
    ++k;
    while (is_digit(k)) ++k, ++digits;
  }
  if (digits == 0) return false;
  if (k < s.size() && (s[k] == 'e' || s[k] == 'E')) {
    ++k;
    if (k < s.size() && (s[k] == '+' || s[k] == '-')) ++k;
    if (!is_digit(k)) return false;
    while (is_digit(k)) ++k;
  }
  return k == s.size();
}

bool names_non_finite(std::string s) {
  std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return std::tolower(c); });
  if (!s.empty() && (s[0] == '+' || s[0] == '-')) s.erase(0, 1);
  return s == "nan" || s == ".nan" || s == "inf" || s == ".inf" || s == "infinity";
}

}  // namespace

std::string to_text(double value) {
  char buffer[40];
  const double size = std::fabs(value);
  const bool fixed = size >= 1e-4 && size < 1e7;  // as people write them; else whatever is shorter
  const auto end =
      fixed ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed).ptr
            : std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  std::string text(buffer, end);
  const std::size_t e = text.find('e');
  if (e != std::string::npos && text.find('.') == std::string::npos) text.insert(e, ".0");
  return text;
}

std::string to_text(const Double3& v) {
  return std::string("[") + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + "]";
}

NumberError read_double(const std::string& text, double& value) {
  bool whole = false;
  if (!is_decimal(text, whole))
    return names_non_finite(text) ? NumberError::not_finite : NumberError::not_a_number;
  const char* first = text.data() + (text[0] == '+' ? 1 : 0);
  const auto result = std::from_chars(first, text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    // from_chars does not say which end was left; a number in magnitude above 1 has its digits so.
    const std::size_t e = text.find_first_of("eE");
    const bool tiny = e != std::string::npos && e + 1 < text.size() && text[e + 1] == '-';
    return tiny ? NumberError::too_small : NumberError::too_large;
  }
  if (value != 0 && std::fabs(value) < std::numeric_limits<double>::min())
    return NumberError::too_small;
  return NumberError::none;
}

NumberError read_integer(const std::string& text, std::int64_t& value) {
  bool whole = false;
  if (is_decimal(text, whole) && whole) {
    const char* first = text.data() + (text[0] == '+' ? 1 : 0);
    const auto result = std::from_chars(first, text.data() + text.size(), value, 10);
    return result.ec == std::errc{} ? NumberError::none : NumberError::too_large;
  }
  double real = 0;
  const NumberError error = read_double(text, real);
  if (error != NumberError::none) return error;
  if (real != std::floor(real)) return NumberError::not_whole;
  if (std::fabs(real) > 0x1p53) return NumberError::too_large;
  value = static_cast<std::int64_t>(real);
  return NumberError::none;
}

std::string describe(NumberError error) {
  switch (error) {
    case NumberError::none:
      return "";
    case NumberError::not_a_number:
      return "is not a number";
    case NumberError::not_finite:
      return "is not finite";
    case NumberError::too_large:
      return "is too large to be represented";
    case NumberError::too_small:
      return "is too small to be represented; write 0";
    case NumberError::not_whole:
      return "is not a whole number";
  }
  return "";
}

std::string count_text(double count) { return format(count < 1e10 ? "%.0f" : "%.3g", count); }

std::string too_many_text(double count) {
  return "the scene would have " + count_text(count) +
         " particles, at most 2147483647 are possible; raise fluid.spacing (twice the spacing: an "
         "eighth of the particles) or make the bodies smaller";
}

}  // namespace pbf::inline scene_module
