// Defines which text is accepted from outside, and how messages show other text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pbf::inline base_module {

/// The first place of a text that is no text.
struct BadText {
  int line = 0, column = 0;  ///< from 0; columns count bytes
  std::string what, remedy;  ///< what stands there, and what to do in the file, for a message
};

/// Text is UTF-8 (RFC 3629: no overlong forms, surrogates or numbers above U+10FFFF) without
/// control characters (C0, DEL, C1) other than tab, line feed and the carriage return at the end of
/// a line: a terminal obeys control characters, and readers of HDF5 and JSON refuse what is not
/// UTF-8.
std::optional<BadText> find_bad_text(std::string_view text);

/// The text with everything that find_bad_text refuses written out: \x9b for a byte that is not
/// UTF-8, \u001b for a control character. Other text comes back as it is. Pure.
std::string escaped(std::string_view text);

/// The same on one line (\n, \r and \t too), cut after about `most` bytes between characters, with
/// "..." where something is missing. Pure.
std::string one_line(std::string_view text, std::size_t most = 200);

/// The text with only the bytes that are not UTF-8 written out, \x9b. Pure.
std::string utf8(std::string_view text);

}  // namespace pbf::inline base_module
