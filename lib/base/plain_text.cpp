#include "lib/base/plain_text.h"

#include <algorithm>

#include "lib/base/text.h"

namespace pbf {
namespace {

/// A character at the start of a text; `code` is -1 where a byte begins none.
struct Character {
  long code;
  std::size_t bytes;
};

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

bool is_control(long code) { return (code >= 0 && code < 0x20) || (code >= 0x7F && code < 0xA0); }

bool is_blank(long code) { return code == '\t' || code == '\n' || code == '\r'; }

/// How a character stands in a message.
std::string shown(std::string_view character, long code, bool one_line) {
  if (code < 0) return format("\\x%02x", static_cast<unsigned char>(character[0]));
  if (!is_control(code) || (!one_line && is_blank(code))) return std::string(character);
  if (is_blank(code)) return code == '\n' ? "\\n" : code == '\r' ? "\\r" : "\\t";
  return format("\\u%04lx", static_cast<unsigned long>(code));
}

}  // namespace

std::optional<BadText> find_bad_text(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = first_character(text.substr(at));
    if (c.code >= 0 && (!is_control(c.code) || is_blank(c.code))) {
      at += c.bytes;
      continue;
    }
    BadText bad;
    const std::string_view before = text.substr(0, at);
    bad.line = static_cast<int>(std::count(before.begin(), before.end(), '\n'));
    bad.column = static_cast<int>(at - (before.rfind('\n') + 1));  // npos + 1 is 0
    if (c.code < 0) {
      bad.what = format("the byte 0x%02x is not UTF-8", static_cast<unsigned char>(text[at]));
      bad.remedy = "save the text as UTF-8";
    } else {
      bad.what = format("the control character U+%04lX", static_cast<unsigned long>(c.code));
      bad.remedy = "remove it";
    }
    return bad;
  }
  return std::nullopt;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (Character c; !text.empty(); text.remove_prefix(c.bytes)) {
    c = first_character(text);
    out += shown(text.substr(0, c.bytes), c.code, false);
  }
  return out;
}

std::string one_line(std::string_view text, std::size_t most) {
  std::string out;
  for (Character c; !text.empty(); text.remove_prefix(c.bytes)) {
    if (out.size() >= most) return out + "...";
    c = first_character(text);
    out += shown(text.substr(0, c.bytes), c.code, true);
  }
  return out;
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (Character c; !text.empty(); text.remove_prefix(c.bytes)) {
    c = first_character(text);
    if (c.code == '"' || c.code == '\\' || c.code < 0) out += '\\';
    out += shown(text.substr(0, c.bytes), c.code, true);
  }
  return out + '"';
}

}  // namespace pbf
