#include "lib/render/overlay.h"

#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/render/colormap.h"
#include "lib/render/font.h"

namespace pbf::inline render_module {
namespace {

constexpr Rgb kInk{42, 48, 58};

std::string number(const char* pattern, int digits, double value) {
  return format(pattern, digits, value == 0 ? 0.0 : value);  // no "-0"
}

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

}  // namespace

std::vector<Tick> ticks_of(std::array<double, 2> range) {
  const double span = range[1] - range[0], raw = span / 5;
  const int power = static_cast<int>(std::floor(std::log10(raw)));
  const double lead = raw / std::pow(10.0, power);
  const double step = (lead < 1.5   ? 1
                       : lead < 3.5 ? 2
                       : lead < 7.5 ? 5
                                    : 10) *
                      std::pow(10.0, power);
  const double largest = std::max(std::abs(range[0]), std::abs(range[1]));
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  for (double i = std::ceil(range[0] / step - 1e-9); i * step <= range[1] + 1e-9 * span; ++i) {
    const double value = i * step;
    const bool plain = largest < 1e7 && decimals <= 4;
    const int digits = 1 + static_cast<int>(std::floor(std::log10(largest / step) + 1e-9));
    ticks.push_back({value, plain ? number("%.*f", decimals, value)
                                  : number("%.*e", std::max(0, digits - 1), value)});
  }
  return ticks;
}

std::string time_text(double seconds) {
  if (seconds != 0 && std::abs(seconds) < 1e-3) return number("t = %.*e s", 2, seconds);
  int decimals = 2;
  for (double scaled = seconds * 100; decimals < 6 && std::abs(scaled - std::round(scaled)) > 0.005;
       scaled *= 10)
    ++decimals;
  return number("t = %.*f s", decimals, seconds);
}

BarPlace bar_place(int width, int height, const std::vector<Tick>& ticks) {
  const double dot = std::max(1.0, 2.0 * height / 720);
  double label = 0;
  for (const auto& tick : ticks) label = std::max(label, text_width(tick.label, dot));
  const double x1 = width - 12 * dot - label - 5 * dot;
  return {std::round(x1 - 9 * dot), std::round(0.27 * height), std::round(x1),
          std::round(0.8 * height), dot};
}

void draw_overlay(Image& image, const std::string& title, const std::string& unit,
                  std::array<double, 2> range, double time, ColorMap map) {
  const auto ticks = ticks_of(range);
  const BarPlace bar = bar_place(image.width, image.height, ticks);
  const double line = std::max(1.0, std::round(0.75 * bar.dot));
  fill(image, bar.x0 - line, bar.y0 - line, bar.x1 + line, bar.y1 + line, [](int) { return kInk; });
  fill(image, bar.x0, bar.y0, bar.x1, bar.y1,
       [&](int y) { return map((bar.y1 - y - 0.5) / (bar.y1 - bar.y0)); });
  for (const auto& tick : ticks) {
    const double share = (tick.value - range[0]) / (range[1] - range[0]);
    const double y = bar.y1 - share * (bar.y1 - bar.y0);
    fill(image, bar.x1 + line, y - 0.5 * line, bar.x1 + line + 3 * bar.dot, y + 0.5 * line,
         [](int) { return kInk; });
    draw_text(image, tick.label, bar.x1 + 5.5 * bar.dot, std::round(y - 3.5 * bar.dot), bar.dot,
              kInk);
  }
  const double wide = std::max(text_width(title, bar.dot), text_width(unit, bar.dot));
  const double left = std::min(bar.x0, image.width - 6 * bar.dot - wide);
  draw_text(image, title, left, bar.y0 - (unit.empty() ? 14 : 26) * bar.dot, bar.dot, kInk);
  draw_text(image, unit, left, bar.y0 - 14 * bar.dot, bar.dot, kInk);
  draw_text(image, time_text(time), 8 * bar.dot, 6 * bar.dot, bar.dot, kInk);
}

}  // namespace pbf::inline render_module
