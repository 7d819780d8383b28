// What is text, and how messages show what is not. The oracle is the table of RFC 3629, section 4.
#include "lib/base/plain_text.h"

#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

/// The syntax of UTF-8 as the RFC lists it: ranges of the first, second, third and fourth byte.
bool is_utf8_character(const std::string& s) {
  struct Row {
    int first[2], rest[3][2];
    std::size_t bytes;
  };
  static const Row kRows[] = {{{0x00, 0x7F}, {}, 1},
                              {{0xC2, 0xDF}, {{0x80, 0xBF}}, 2},
                              {{0xE0, 0xE0}, {{0xA0, 0xBF}, {0x80, 0xBF}}, 3},
                              {{0xE1, 0xEC}, {{0x80, 0xBF}, {0x80, 0xBF}}, 3},
                              {{0xED, 0xED}, {{0x80, 0x9F}, {0x80, 0xBF}}, 3},
                              {{0xEE, 0xEF}, {{0x80, 0xBF}, {0x80, 0xBF}}, 3},
                              {{0xF0, 0xF0}, {{0x90, 0xBF}, {0x80, 0xBF}, {0x80, 0xBF}}, 4},
                              {{0xF1, 0xF3}, {{0x80, 0xBF}, {0x80, 0xBF}, {0x80, 0xBF}}, 4},
                              {{0xF4, 0xF4}, {{0x80, 0x8F}, {0x80, 0xBF}, {0x80, 0xBF}}, 4}};
  const auto in = [&s](std::size_t k, const int(&range)[2]) {
    const int c = static_cast<unsigned char>(s[k]);
    return c >= range[0] && c <= range[1];
  };
  for (const Row& row : kRows) {
    bool good = row.bytes == s.size() && in(0, row.first);
    for (std::size_t k = 1; good && k < row.bytes; ++k) good = in(k, row.rest[k - 1]);
    if (good) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("text is the UTF-8 of RFC 3629 without control characters, over all first two bytes") {
  long good = 0;
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b)
      for (const std::string tail : {"", "\x80", "\xBF", "\x80\x80", "\xBF\xBF"}) {
        const std::string s = std::string(1, char(a)) + char(b) + tail;
        const bool c1 = a == 0xC2 && b < 0xA0;
        const bool expected = is_utf8_character(s) && !c1;
        if (a >= 0x80 && find_bad_text(s).has_value() == expected) {
          CAPTURE(a, b, tail.size());
          REQUIRE(find_bad_text(s).has_value() == !expected);
        }
        good += expected;
      }
  CHECK(good > 1000);
  for (int c = 0; c < 128; ++c) {
    const std::string s(1, char(c));
    const bool blank = c == '\t' || c == '\n' || c == '\r';
    CAPTURE(c);
    CHECK(find_bad_text(s).has_value() == ((c < 0x20 && !blank) || c == 0x7F));
  }
}

TEST_CASE("what is no text is named with its line and column") {
  const auto bad = find_bad_text("one\ntwo \xc2\x9b three");
  REQUIRE(bad);
  CHECK(bad->line == 1);
  CHECK(bad->column == 4);
  CHECK(bad->what == "the control character U+009B");
  CHECK(find_bad_text("caf\xe9")->what == "the byte 0xe9 is not UTF-8");
  CHECK(find_bad_text("\xe2\x82")->column == 0);  // cut off
  CHECK_FALSE(find_bad_text("caf\u00e9 \u20ac \U0001F30A\ttab\r\n"));
}

TEST_CASE("escaped text is text, keeps what was text, and shows the rest") {
  const std::string nasty("a\x1b[2J\x7f\0\xc2\x9b\xff\xed\xa0\x80z", 14);
  CHECK(escaped(nasty) == "a\\u001b[2J\\u007f\\u0000\\u009b\\xff\\xed\\xa0\\x80z");
  CHECK(escaped("caf\u00e9\n\tline") == "caf\u00e9\n\tline");
  CHECK(escaped("crlf\r\nend\r") == "crlf\r\nend\r");
  CHECK(escaped("over\rwritten") == "over\\rwritten");
  CHECK(find_bad_text("over\rwritten")->what == "the control character U+000D");
  CHECK(one_line("a\r\nb\tc") == "a\\r\\nb\\tc");
  CHECK(one_line(std::string(300, 'x')) == std::string(200, 'x') + "...");
  CHECK(one_line("\u20ac\u20ac\u20ac", 4) == "\u20ac\u20ac...");
  CHECK(one_line("abc", 3) == "abc");
  CHECK(json_text(nasty) == "\"a\\u001b[2J\\u007f\\u0000\\u009b\\\\xff\\\\xed\\\\xa0\\\\x80z\"");
}
