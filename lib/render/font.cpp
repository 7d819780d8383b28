#include "lib/render/font.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace pbf::render_module {
namespace {

constexpr char32_t kMissing = 0xfffd, kEllipsis = 0x2026;

struct Typeface {
  stbtt_fontinfo info{};
  Typeface() {
    if (!stbtt_InitFont(&info, kFontData, 0))
      throw Error(ExitCode::internal, "the embedded font cannot be read");
  }
};
const stbtt_fontinfo& typeface() {
  static const Typeface one;
  return one.info;
}

bool has_glyph(char32_t c) {
  const bool latin_1 = (c >= 0x20 && c < 0x7f) || (c >= 0xa0 && c < 0x100);
  return latin_1 || c == kEllipsis || c == kMissing;
}

/// Reads the character at text[i] and goes behind it; kMissing where the font has no glyph.
char32_t next_character(const std::string& text, std::size_t& i) {
  const Character c = first_character(std::string_view(text).substr(i));
  i += c.bytes;
  return has_glyph(char32_t(c.code)) ? char32_t(c.code) : kMissing;
}

float scale_of(double size) {
  return stbtt_ScaleForMappingEmToPixels(&typeface(), static_cast<float>(size));
}

double advance(char32_t c, double size) {
  int width = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&typeface(), static_cast<int>(c), &width, &bearing);
  return static_cast<double>(scale_of(size)) * width;
}

void draw_glyph(Image& image, char32_t c, double x, double line, double size, Rgb color) {
  const float scale = scale_of(size);
  const double left = std::floor(x), top = std::floor(line);
  const auto shift_x = static_cast<float>(x - left), shift_y = static_cast<float>(line - top);
  const int glyph = stbtt_FindGlyphIndex(&typeface(), static_cast<int>(c));
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&typeface(), glyph, scale, scale, shift_x, shift_y, &x0, &y0, &x1,
                                  &y1);
  const int width = x1 - x0, height = y1 - y0;
  // Also where the place is too far away for an int.
  if (width <= 0 || height <= 0 || !(left + x1 > 0 && left + x0 < image.width) ||
      !(top + y1 > 0 && top + y0 < image.height))
    return;
  std::vector<std::uint8_t> cover(static_cast<std::size_t>(width) * height);
  stbtt_MakeGlyphBitmapSubpixel(&typeface(), cover.data(), width, height, width, scale, scale,
                                shift_x, shift_y, glyph);
  const int from_x = static_cast<int>(left) + x0, from_y = static_cast<int>(top) + y0;
  for (int j = std::max(0, -from_y); j < height && from_y + j < image.height; ++j)
    for (int i = std::max(0, -from_x); i < width && from_x + i < image.width; ++i) {
      const int share = cover[static_cast<std::size_t>(j) * width + i];
      auto* at = &image.rgb[3 * (static_cast<std::size_t>(from_y + j) * image.width + from_x + i)];
      for (std::size_t k = 0; k < 3; ++k)
        at[k] = static_cast<std::uint8_t>((at[k] * (255 - share) + color[k] * share + 127) / 255);
    }
}

}  // namespace

std::vector<char32_t> drawn_characters(const std::string& text) {
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < text.size();) out.push_back(next_character(text, i));
  return out;
}

void draw_text(Image& image, const std::string& text, double x, double y, double size, Rgb color) {
  for (const char32_t c : drawn_characters(text)) {
    draw_glyph(image, c, x, y + kCapitalHeight * size, size, color);
    x += advance(c, size);
  }
}

double text_width(const std::string& text, double size) {
  double width = 0;
  for (const char32_t c : drawn_characters(text)) width += advance(c, size);
  return width;
}

std::string shortened(const std::string& text, double width, double size) {
  if (text_width(text, size) <= width) return text;
  double used = advance(kEllipsis, size);
  if (used > width) return "";
  std::size_t end = 0;
  for (std::size_t i = 0; i < text.size(); end = i) {
    used += advance(next_character(text, i), size);
    if (used > width) break;
  }
  return text.substr(0, end) + "\u2026";
}

TextBox Texts::box_of(const std::string& text, double x, double y) const {
  return {x, y - 0.28 * size_, x + text_width(text, size_),
          y + (kCapitalHeight + kDescent) * size_};
}

bool Texts::fits(const TextBox& box) const {
  const double r = rim();
  return box.x0 >= r && box.y0 >= 0 && box.x1 <= image_.width - r && box.y1 <= image_.height &&
         std::ranges::none_of(taken_, [&](const TextBox& b) { return b.meets(box); });
}

void Texts::put(const std::string& text, double x, double y, Rgb color) {
  constexpr Rgb light{246, 248, 250};
  const TextBox box = box_of(text, x, y);
  if (text.empty() || !fits(box)) return;
  taken_.push_back(box);
  const double r = rim();
  for (const auto& [dx, dy] : {std::array{-r, 0.0}, {r, 0.0}, {0.0, -r}, {0.0, r}})
    draw_text(image_, text, x + dx, y + dy, size_, light);
  draw_text(image_, text, x, y, size_, color);
}

}  // namespace pbf::render_module
