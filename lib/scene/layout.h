// Mistakes of writing that YAML reads as something else or as nothing: spaces, colons and brackets
// that are missing, wrong indentation. Each function gives a phrase with the remedy, to stand
// behind what is wrong, or nothing.
#pragma once

#include <string>

namespace pbf::inline scene_module {

/// For "step:0.002", which is a text to YAML and no key: "; a space is missing behind step:".
std::string missing_space(const std::string& text);

/// For "every 0.1", a key in braces without a value: "; a colon is missing behind "every"".
std::string missing_colon(const std::string& text);

/// For a file that is not valid YAML from this line on (counted from 0), for the reason that
/// yaml-cpp gives: what its lines up to there show.
std::string layout_remedy(const std::string& text, int line, const std::string& reason = "");

}  // namespace pbf::inline scene_module
