// A small built-in font: 5x7 dots, drawn as round strokes between neighbouring dots, so that it is
// smooth at any size.
#pragma once

#include <string>

#include "lib/render/colormap.h"
#include "lib/render/renderer.h"

namespace pbf::inline render_module {

/// Draws one line of ASCII text, clipped to the image. (x, y): left end and top of the capitals, in
/// pixels. `dot`: pixels between neighbouring dots (capitals are 7 dots high). "^" raises the next
/// character; characters that the font lacks are drawn as "?".
void draw_text(Image& image, const std::string& text, double x, double y, double dot, Rgb color);

/// Width of the text in pixels.
double text_width(const std::string& text, double dot);

}  // namespace pbf::inline render_module
