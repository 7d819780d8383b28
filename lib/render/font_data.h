// The embedded font, lib/render/font/DejaVuSans-Latin1.ttf.
#pragma once

namespace pbf::render_module {

extern const unsigned char kFontData[];  ///< a TrueType file

}  // namespace pbf::render_module
