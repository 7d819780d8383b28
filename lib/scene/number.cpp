#include "lib/scene/number.h"

#include <fmt/core.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace pbf::scene_module {
namespace {

bool names_non_finite(std::string s) {
  std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return std::tolower(c); });
  if (!s.empty() && (s[0] == '+' || s[0] == '-')) s.erase(0, 1);
  return s == "nan" || s == ".nan" || s == "inf" || s == ".inf" || s == "infinity";
}

}  // namespace

std::string to_text(double value) {
  char buffer[40];
  const double size = std::fabs(value);
  const bool fixed = size >= 1e-4 && size < 1e7;  // plain digits; otherwise the shorter form
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

NumberError read_number(const std::string& text, double& value) {
  // Excludes the other forms that from_chars accepts, and allows a plus, which it rejects.
  const bool decimal = !text.empty() && text.find_first_not_of("+-.0123456789eE") == text.npos;
  const char* first = text.data() + (decimal && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* last = text.data() + text.size();
  const auto result = std::from_chars(first, last, value);
  if (!decimal || result.ec == std::errc::invalid_argument || result.ptr != last)
    return names_non_finite(text) ? NumberError::not_finite : NumberError::not_a_number;
  if (result.ec == std::errc::result_out_of_range) {
    // from_chars does not tell overflow from underflow; the sign of the exponent does.
    const std::size_t e = text.find_first_of("eE");
    const bool tiny = e != std::string::npos && e + 1 < text.size() && text[e + 1] == '-';
    return tiny ? NumberError::too_small : NumberError::too_large;
  }
  if (value != 0 && std::fabs(value) < std::numeric_limits<double>::min())
    return NumberError::too_small;
  return NumberError::none;
}

NumberError read_number(const std::string& text, std::int64_t& value) {
  double real = 0;
  const NumberError error = read_number(text, real);
  const bool digits = text.find_first_of(".eE") == std::string::npos;
  if (digits && (error == NumberError::none || error == NumberError::too_large)) {
    const char* first = text.data() + (text[0] == '+' ? 1 : 0);
    const auto result = std::from_chars(first, text.data() + text.size(), value);
    return result.ec == std::errc{} ? NumberError::none : NumberError::too_large;
  }
  if (error != NumberError::none) return error;
  if (real != std::floor(real)) return NumberError::not_whole;
  if (std::fabs(real) > 0x1p53) return NumberError::inexact;
  value = static_cast<std::int64_t>(real);
  return NumberError::none;
}

std::string describe(NumberError error) {
  static const char* const kTexts[] = {"",  // in the order of NumberError
                                       "is not a number",
                                       "is not finite",
                                       "is too large to be represented",
                                       "is too small to be represented; write 0",
                                       "is not a whole number",
                                       "is too large to be exact with a point or an exponent; "
                                       "write all its digits"};
  return kTexts[static_cast<int>(error)];
}

std::string count_text(double count) {
  return count < 1e10 ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

std::string too_many_text(double count) {
  return "the scene would have " + count_text(count) +
         " particles, at most 2147483647 are possible; raise fluid.spacing (twice the spacing: an "
         "eighth of the particles) or make the bodies smaller";
}

}  // namespace pbf::scene_module
