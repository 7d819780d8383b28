// Converts numbers to text and back without locale, for scene files and messages.
#pragma once

#include <cstdint>
#include <string>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// Fewest digits that read back to the same double: 0.1, 1000, 1.0e-05. A number with an exponent
/// always has a point, because YAML 1.1 readers take 1e-05 for text.
std::string to_text(double value);
inline std::string to_text(int value) { return std::to_string(value); }
/// [x, y, z]
std::string to_text(const Double3& value);

/// The result of reading a number.
enum class NumberError { none, not_a_number, not_finite, too_large, too_small, not_whole, inexact };

/// Decimal numbers only ([+-]digits[.digits][e[+-]digits]); no octal, hex, underscores. Denormal
/// values are `too_small`: arithmetic on them loses digits and speed.
NumberError read_number(const std::string& text, double& value);
/// The same grammar; 1e3 and 4.0 are whole, up to 2^53, beyond which a double is not exact. Leading
/// zeros are allowed: 010 is 10.
NumberError read_number(const std::string& text, std::int64_t& value);
/// "is not finite" and so on, to append to the text in a message.
std::string describe(NumberError error);

/// A whole number for messages: all digits below 1e10, otherwise three: 6.4e+13.
std::string count_text(double count);

/// Message for a scene with more particles than ids.
std::string too_many_text(double count);

}  // namespace pbf::scene_module
