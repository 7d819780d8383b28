// Common mistakes in values: units, commas, axes. Each function returns a remedy to append to the
// error message, or an empty string.
#pragma once

#include <string>

namespace pbf::scene_module {

/// For `text` instead of a number in `unit` (empty: none): "; leave the unit out, the key is in s:
/// write 0.002".
std::string number_remedy(const std::string& text, const std::string& unit);

/// "0 0 -9.81" instead of a list of `numbers` numbers: "; write [0, 0, -9.81]"; else empty.
std::string list_remedy(const std::string& text, std::size_t numbers);

/// "-z" instead of a direction: "; write [0, 0, -1]"; else empty.
std::string axis_remedy(const std::string& text);

}  // namespace pbf::scene_module
