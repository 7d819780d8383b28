// The embedded font, lib/render/font/DejaVuSans-Latin1.ttf.
#pragma once

namespace pbf::inline render_module {

extern const unsigned char kFontData[];  ///< a TrueType file

}  // namespace pbf::inline render_module
