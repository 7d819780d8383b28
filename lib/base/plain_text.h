// Defines which text is accepted as input, and how messages show invalid text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pbf::base_module {

/// The first character of a text; `code` is -1 if the first byte does not begin a valid one.
struct Character {
  long code;
  std::size_t bytes;  ///< 1 for such a byte
};
Character first_character(std::string_view text);

/// The first invalid byte or character of a text.
struct BadText {
  int line = 0, column = 0;  ///< from 0; columns count bytes
  std::string what, remedy;  ///< for a message: what is wrong there, and how to correct the file
};

/// Valid text is UTF-8 (RFC 3629: no overlong forms, surrogates or numbers above U+10FFFF) without
/// control characters (C0, DEL, C1) other than tab, line feed and the carriage return at the end of
/// a line. Reasons: terminals execute control characters, and readers of HDF5 and JSON reject bytes
/// that are not UTF-8.
std::optional<BadText> find_bad_text(std::string_view text);

/// Replaces everything that find_bad_text() rejects by an escape: \x9b for a byte that is not
/// UTF-8, \u001b for a control character. Pure.
std::string escaped(std::string_view text);

/// The same on one line (\n, \r and \t are escaped too), cut between characters after about `most`
/// bytes and then ended with "...". Pure.
std::string one_line(std::string_view text, std::size_t most = 200);

/// Escapes only the bytes that are not UTF-8 (\x9b). Pure.
std::string utf8(std::string_view text);

}  // namespace pbf::base_module
