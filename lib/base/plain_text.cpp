#include "lib/base/plain_text.h"

#include <fmt/core.h>
#include <algorithm>

namespace pbf::base_module {
namespace {

bool is_control(long code) { return (code >= 0 && code < 0x20) || (code >= 0x7F && code < 0xA0); }

/// Whether the first character of a text is a tab or part of a line end. A carriage return within a
/// line is neither: it makes a terminal overwrite the line.
bool is_blank(std::string_view text) {
  const char c = text[0];
  return c == '\t' || c == '\n' || (c == '\r' && (text.size() == 1 || text[1] == '\n'));
}

enum class Form { lines, one_line, utf8 };

/// The form in which a message shows the first character of a text.
std::string shown(std::string_view text, const Character& c, Form form) {
  if (c.code < 0) return fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
  if (!is_control(c.code) || form == Form::utf8 || (form == Form::lines && is_blank(text)))
    return std::string(text.substr(0, c.bytes));
  if (c.code == '\n') return "\\n";
  if (c.code == '\r') return "\\r";
  if (c.code == '\t') return "\\t";
  return fmt::format("\\u{:04x}", static_cast<unsigned long>(c.code));
}

std::string written(std::string_view text, Form form, std::size_t most = std::string::npos) {
  std::string out;
  for (Character c; !text.empty(); text.remove_prefix(c.bytes)) {
    if (out.size() >= most) return out + "...";
    c = first_character(text);
    out += shown(text, c, form);
  }
  return out;
}

}  // namespace

Character first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned c = byte(0);
  if (c < 0x80) return {static_cast<long>(c), 1};
  const std::size_t bytes = c >= 0xC2 && c < 0xE0 ? 2 : c >= 0xE0 && c < 0xF0 ? 3 : 4;
  if (c < 0xC2 || c > 0xF4 || text.size() < bytes) return {-1, 1};
  long code = static_cast<long>(c & (0x7Fu >> bytes));
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0u) != 0x80u) return {-1, 1};
    code = code * 64 + static_cast<long>(byte(k) & 0x3Fu);
  }
  const bool overlong = code < (bytes == 3 ? 0x800 : bytes == 4 ? 0x10000 : 0x80);
  if (overlong || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF) return {-1, 1};
  return {code, bytes};
}

std::optional<BadText> find_bad_text(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = first_character(text.substr(at));
    if (c.code >= 0 && (!is_control(c.code) || is_blank(text.substr(at)))) {
      at += c.bytes;
      continue;
    }
    BadText bad;
    const std::string_view before = text.substr(0, at);
    bad.line = static_cast<int>(std::count(before.begin(), before.end(), '\n'));
    bad.column = static_cast<int>(at - (before.rfind('\n') + 1));  // npos + 1 is 0
    if (c.code < 0) {
      bad.what =
          fmt::format("the byte 0x{:02x} is not UTF-8", static_cast<unsigned char>(text[at]));
      bad.remedy = "save the text as UTF-8";
    } else {
      bad.what = fmt::format("the control character U+{:04X}", static_cast<unsigned long>(c.code));
      bad.remedy = "remove it";
    }
    return bad;
  }
  return std::nullopt;
}

std::string escaped(std::string_view text) { return written(text, Form::lines); }

std::string one_line(std::string_view text, std::size_t most) {
  return written(text, Form::one_line, most);
}

std::string utf8(std::string_view text) { return written(text, Form::utf8); }

}  // namespace pbf::base_module
