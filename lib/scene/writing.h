// Mistakes of writing in values: units, commas, axes. Each function gives a phrase with the remedy,
// to stand behind what is wrong, or nothing.
#pragma once

#include <string>

namespace pbf::inline scene_module {

/// For `text` in the place of a number in `unit` (empty: none): "; leave the unit out, the key is
/// in s: write 0.002".
std::string number_remedy(const std::string& text, const std::string& unit);

/// "0 0 -9.81" in the place of a list of so many numbers: "; write [0, 0, -9.81]"; else empty.
std::string list_remedy(const std::string& text, std::size_t numbers);

/// "-z" in the place of a direction: "; write [0, 0, -1]"; else empty.
std::string axis_remedy(const std::string& text);

}  // namespace pbf::inline scene_module
