// What is written onto a picture: the colour bar with its unit and numbers, and the time.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lib/render/colormap.h"
#include "lib/render/renderer.h"

namespace pbf::inline render_module {

struct Tick {
  double value;
  std::string label;
};

/// Ticks of a scale from range[0] to range[1] (range[0] < range[1]): multiples of 1, 2 or 5 times a
/// power of ten, 3 to 7 of them, with as many digits as their step needs.
std::vector<Tick> ticks_of(std::array<double, 2> range);

/// "t = 0.52 s": two decimals, more where the time has them, powers of ten below a millisecond.
std::string time_text(double seconds);

/// Where the colour bar lies, in pixels.
struct BarPlace {
  double x0, y0, x1, y1, dot;  ///< dot: size of the font's dots
};
BarPlace bar_place(int width, int height, const std::vector<Tick>& ticks);

/// Draws all of it. `title` and `unit` stand above the bar ("" for no unit); `map` colours it.
void draw_overlay(Image& image, const std::string& title, const std::string& unit,
                  std::array<double, 2> range, double time, ColorMap map = viridis);

}  // namespace pbf::inline render_module
