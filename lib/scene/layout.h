// Common mistakes that YAML reads as something else: missing spaces, colons and brackets, wrong
// indentation. Each function returns a remedy to append to the error message, or an empty string.
#pragma once

#include <string>

namespace pbf::scene_module {

/// For "step:0.002", which YAML reads as text: "; a space is missing behind step:".
std::string missing_space(const std::string& text);

/// For "every 0.1", a key in braces without a value: "; a colon is missing behind "every"".
std::string missing_colon(const std::string& text);

/// For a file that is not valid YAML from this line on (counted from 0), with the reason from
/// yaml-cpp. Examines the lines up to there.
std::string layout_remedy(const std::string& text, int line, const std::string& reason = "");

}  // namespace pbf::scene_module
