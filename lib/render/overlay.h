// What is written onto a picture: the scene's name, time and number of particles, the colour bar
// with its unit and numbers, and lengths.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lib/render/camera.h"
#include "lib/render/font.h"

namespace pbf::render_module {

struct Tick {
  double value;
  std::string label;
};

/// Ticks of a scale from range[0] to range[1] (range[0] < range[1]): multiples of 1, 2 or 5 times a
/// power of ten, 3 to 7 of them, with as many digits as their step needs.
std::vector<Tick> ticks_of(std::array<double, 2> range);

/// "t = 0.52 s": two decimals, more where the time has them, powers of ten below a millisecond.
std::string time_text(double seconds);

/// "1 particle", "31 250 particles".
std::string particles_text(std::int64_t count);

/// Size of the text in a picture, pixels per em: a 38th of its height, less in a narrow picture, at
/// least 11.
double text_size(std::array<int, 2> picture);

/// Shares of the picture's width and height that the default camera leaves to the labels.
struct Margins {
  double left, right, top, bottom;
};
Margins margins_of(const View& view);

/// Where the colour bar lies.
TextBox bar_place(std::array<int, 2> picture, const std::vector<Tick>& ticks);

/// Draws all of it. `unit` of the colour bar, "" for none; "^2" and "^3" are raised. A text that
/// does not fit the picture, or would overlap another one, is left out, and so is the bar of a tiny
/// picture; a long name is cut.
void draw_overlay(Image& image, const View& view, const Projection& projection,
                  const std::string& unit, std::int64_t particles, double time);

}  // namespace pbf::render_module
