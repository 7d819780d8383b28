// Common mistakes in a scene file. Each function returns a remedy to append to the error message,
// or an empty string.
#pragma once

#include <string>

namespace pbf::scene_module {

// What YAML reads as something else (layout.cpp): missing spaces, colons and brackets, wrong
// indentation.

/// For "step:0.002", which YAML reads as text: "; a space is missing behind step:".
std::string missing_space(const std::string& text);

/// For "every 0.1", a key in braces without a value: "; a colon is missing behind "every"".
std::string missing_colon(const std::string& text);

/// For a file that is not valid YAML from this line on (counted from 0), with the reason from
/// yaml-cpp. Examines the lines up to there.
std::string layout_remedy(const std::string& text, int line, const std::string& reason = "");

// Values (writing.cpp): units, commas, axes.

/// For `text` instead of a number in `unit` (empty: none): "; leave the unit out, the key is in s:
/// write 0.002".
std::string number_remedy(const std::string& text, const std::string& unit);

/// "0 0 -9.81" instead of a list of `numbers` numbers: "; write [0, 0, -9.81]"; else empty.
std::string list_remedy(const std::string& text, std::size_t numbers);

/// "-z" instead of a direction: "; write [0, 0, -1]"; else empty.
std::string axis_remedy(const std::string& text);

}  // namespace pbf::scene_module
