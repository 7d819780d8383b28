// Quoting of words for the scripts that pbf prints.
#pragma once

#include <string>

namespace pbf::app_module {

/// `text` as one word of bash on one line: unquoted if that is safe, else in single quotes or, with
/// control characters (a line break would end a comment), in $'...' with escapes.
std::string shell_quoted(const std::string& text);

}  // namespace pbf::app_module
