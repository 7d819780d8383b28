// Text on pictures, in the embedded font (lib/render/font): the whole of Latin-1.
#pragma once

#include <string>
#include <vector>

#include "lib/render/colormap.h"
#include "lib/render/renderer.h"

namespace pbf::render_module {

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

}  // namespace pbf::render_module
