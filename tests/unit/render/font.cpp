// The embedded font: the whole of Latin-1, UTF-8, and where the ink of a text is.
#include "lib/render/font.h"

#include <map>

#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

constexpr Rgb kBlack{0, 0, 0};

Image blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height, 255)};
}

std::string utf8_of(char32_t c) {  // below U+0800
  if (c < 0x80) return {static_cast<char>(c)};
  return {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 0x3f))};
}

/// Where the picture is not white: x0, x1, y0, y1, half open.
std::array<int, 4> inked(const Image& image) {
  std::array<int, 4> b{image.width, 0, image.height, 0};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (pixel(image, x, y) != Rgb{255, 255, 255})
        b = {std::min(b[0], x), std::max(b[1], x + 1), std::min(b[2], y), std::max(b[3], y + 1)};
  return b;
}

std::vector<char32_t> latin_1() {
  std::vector<char32_t> all;
  for (char32_t c = 0x21; c < 0x100; ++c)
    if ((c < 0x7f || c > 0xa0) && c != 0xad) all.push_back(c);  // no space, no soft hyphen
  return all;
}

}  // namespace

TEST_CASE("every printable character of Latin-1 has ink of its own, inside its line", "[render]") {
  std::map<std::vector<std::uint8_t>, char32_t> seen;
  for (const char32_t c : latin_1()) {
    INFO("U+" << std::hex << static_cast<unsigned>(c));
    CHECK(drawn_characters(utf8_of(c)) == std::vector<char32_t>{c});
    Image image = blank(60, 80);
    draw_text(image, utf8_of(c), 20, 30, 24, kBlack);
    const auto [x0, x1, y0, y1] = inked(image);
    REQUIRE(x0 < x1);
    CHECK(x0 >= 18);
    CHECK(x1 <= 20 + text_width(utf8_of(c), 24) + 2);
    CHECK(y0 >= 30 - 6);
    CHECK(y1 <= 30 + 24 * (kCapitalHeight + kDescent) + 1);
    const auto [twin, is_new] = seen.emplace(image.rgb, c);
    INFO("looks like U+" << static_cast<unsigned>(twin->second));
    CHECK(is_new);
  }
  CHECK(seen.size() == 94 + 94);
}

TEST_CASE("characters that are taken for each other differ also in a small picture", "[render]") {
  for (const auto& [a, b] : std::vector<std::pair<const char*, const char*>>{{"O", "0"},
                                                                             {"l", "1"},
                                                                             {"I", "l"},
                                                                             {"5", "S"},
                                                                             {"8", "B"},
                                                                             {"a", "ä"},
                                                                             {"e", "é"},
                                                                             {"c", "ç"},
                                                                             {"n", "ñ"},
                                                                             {"µ", "u"},
                                                                             {"²", "³"},
                                                                             {"×", "x"},
                                                                             {".", ","},
                                                                             {"@", "a"}}) {
    Image one = blank(20, 24), two = blank(20, 24);
    draw_text(one, a, 4, 6, 11, kBlack);
    draw_text(two, b, 4, 6, 11, kBlack);
    double off = 0;
    for (std::size_t i = 0; i < one.rgb.size(); i += 3)
      off += std::abs(one.rgb[i] - two.rgb[i]) / 255.0;
    INFO(a << " and " << b);
    CHECK(off > 1.2);  // pixels, of about 15 that are black
  }
}

TEST_CASE("what is not Latin-1, or not UTF-8, is one replacement character each", "[render]") {
  using U = std::vector<char32_t>;
  CHECK(drawn_characters("aä@") == U{'a', 0xe4, '@'});
  CHECK(drawn_characters("水") == U{0xfffd});
  CHECK(drawn_characters("x🌊y") == U{'x', 0xfffd, 'y'});
  CHECK(drawn_characters("…") == U{0x2026});
  CHECK(drawn_characters("Ω") == U{0xfffd});
  CHECK(drawn_characters("\x01\t\x7f") == U{0xfffd, 0xfffd, 0xfffd});
  CHECK(drawn_characters("\xc2\x85") == U{0xfffd});     // a control character
  CHECK(drawn_characters("\xff") == U{0xfffd});         // no UTF-8
  CHECK(drawn_characters("\xe4z") == U{0xfffd, 'z'});   // Latin-1 as it is
  CHECK(drawn_characters("z\xc3") == U{'z', 0xfffd});   // cut off
  CHECK(drawn_characters("\xc1\x81") == U(2, 0xfffd));  // longer than it must be
  CHECK(drawn_characters("\xf0\x80\x80") == U(3, 0xfffd));
  Image image = blank(30, 30), letter = blank(30, 30);
  draw_text(image, "水", 5, 5, 16, kBlack);
  draw_text(letter, "?", 5, 5, 16, kBlack);
  CHECK(inked(image)[0] < inked(image)[1]);
  CHECK(image.rgb != letter.rgb);
}

TEST_CASE("capitals stand on the line and have their height, at any size and place", "[render]") {
  for (const double size : {9.0, 11.0, 19.0, 57.0, 200.0})
    for (const double y : {3.0, 3.5}) {
      Image image = blank(300, 300);
      draw_text(image, "H", 4, y, size, kBlack);
      const auto [x0, x1, y0, y1] = inked(image);
      INFO("size " << size << " y " << y);
      CHECK(y0 == Approx(y).margin(1));
      CHECK(y1 == Approx(y + kCapitalHeight * size).margin(1));
      CHECK(text_width("HH", size) == Approx(2 * text_width("H", size)));
      CHECK(text_width("H", size) == Approx(0.752 * size).epsilon(0.01));  // of DejaVu Sans
    }
}

TEST_CASE("a text that is too wide is cut between characters and ends in an ellipsis", "[render]") {
  const std::string text = "Tröpfchen im Meßrohr";
  const double whole = text_width(text, 16);
  CHECK(shortened(text, whole, 16) == text);
  CHECK(shortened(text, 1, 16).empty());
  for (double width = 20; width < whole; width += 3) {
    const std::string cut = shortened(text, width, 16);
    INFO(cut);
    CHECK(text_width(cut, 16) <= width);
    CHECK(cut.substr(cut.size() - 3) == "…");
    CHECK(text.compare(0, cut.size() - 3, cut, 0, cut.size() - 3) == 0);
    const auto characters = drawn_characters(cut);
    CHECK(std::count(characters.begin(), characters.end(), char32_t{0xfffd}) == 0);
  }
}

TEST_CASE("text is clipped to the picture, wherever it is", "[render]") {
  Image image = blank(8, 8);
  for (const double x : {-20.0, 4.0, 7.9, 1e12, -1e12})
    for (const double y : {-30.0, -3.0, 7.5, 1e12}) draw_text(image, "wide @", x, y, 16, kBlack);
  CHECK(image.rgb.size() == 3u * 8 * 8);
}

TEST_CASE("the same text has the same bytes on every machine", "[render]") {
  Image image = blank(400, 40);
  draw_text(image, "Übergröße @ 320×240: 3½ kg/m³ …", 3.3, 8.7, 17.3, {42, 48, 58});
  std::uint64_t hash = 1469598103934665603u;  // FNV-1a
  for (const std::uint8_t byte : image.rgb) hash = (hash ^ byte) * 1099511628211u;
  CHECK(hash == 0x4e3b5cbc093711c2u);
}
