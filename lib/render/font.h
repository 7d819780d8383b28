// Text on pictures, in the embedded font (lib/render/font): the whole of Latin-1. Filled
// rectangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lib/render/colormap.h"
#include "lib/render/renderer.h"

namespace pbf::render_module {

extern const unsigned char kFontData[];  ///< lib/render/font/DejaVuSans-Latin1.ttf

inline constexpr double kCapitalHeight = 0.729;  ///< of a capital letter, in sizes of the font
inline constexpr double kDescent = 0.236;        ///< how far a "g" or "ç" goes below the line

/// The characters of UTF-8 text that are drawn, as code points: what the font lacks (and each byte
/// that is not UTF-8) is the replacement character, a question mark in a diamond.
std::vector<char32_t> drawn_characters(const std::string& text);

/// Draws one line of UTF-8 text, antialiased, clipped to the image. (x, y): left end and top of the
/// capitals, in pixels; `size`: pixels per em. The same bytes on every machine: floating-point
/// sums, products and square roots alone.
void draw_text(Image& image, const std::string& text, double x, double y, double size, Rgb color);

/// Width of the text in pixels.
double text_width(const std::string& text, double size);

/// The text, or as much of its beginning as is at most `width` pixels wide with "…" behind it;
/// "" where not even that fits.
std::string shortened(const std::string& text, double width, double size);

inline constexpr Rgb kInk{42, 48, 58}, kFaintInk{92, 102, 116};

/// Fills [x0, x1) x [y0, y1), clipped; the colour of a row comes from `color(y)`.
template <class F>
void fill(Image& image, double x0, double y0, double x1, double y1, F color) {
  const auto edge = [](double v, int end) {
    return static_cast<int>(std::clamp(std::round(v), 0.0, static_cast<double>(end)));
  };
  for (int y = edge(y0, image.height); y < edge(y1, image.height); ++y) {
    const Rgb c = color(y);
    for (int x = edge(x0, image.width); x < edge(x1, image.width); ++x)
      std::copy(c.begin(), c.end(),
                image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x));
  }
}

/// Pixels.
struct TextBox {
  double x0, y0, x1, y1;
  bool meets(const TextBox& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// Texts of one size on a picture, none over another.
class Texts {
 public:
  /// `size`: pixels per em.
  Texts(Image& image, double size) : image_(image), size_(size) {}

  void keep_free(const TextBox& box) { taken_.push_back(box); }
  /// The room of a text whose capitals' top left corner is at (x, y).
  TextBox box_of(const std::string& text, double x, double y) const;
  /// Whether the box lies in the picture and on nothing that is taken.
  bool fits(const TextBox& box) const;
  /// Draws it where it fits, with a light rim, so that it is read on fluid too.
  void put(const std::string& text, double x, double y, Rgb color);

 private:
  double rim() const { return std::max(1.0, 0.06 * size_); }  ///< its width, pixels

  Image& image_;
  double size_;
  std::vector<TextBox> taken_;
};

}  // namespace pbf::render_module
