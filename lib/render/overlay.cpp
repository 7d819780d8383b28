#include "lib/render/overlay.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/render/grid.h"

namespace pbf::render_module {
namespace {

constexpr double kLine = 1.4;    // from one line of text to the next, in sizes of the text
constexpr double kLeastBar = 4;  // height of a colour bar, in sizes of the text

double without_minus_zero(double value) { return value == 0 ? 0.0 : value; }

/// m/s, kg/m^3 -> kg/m³
std::string raised(std::string unit) {
  for (const auto& [from, to] : {std::array{"^2", "²"}, {"^3", "³"}})
    if (const auto at = unit.find(from); at != std::string::npos) unit.replace(at, 2, to);
  return unit;
}

void draw_bar(Image& image, Texts& texts, const View& view, const std::string& unit) {
  const auto ticks = ticks_of(view.range);
  const double size = text_size(view.size);
  const TextBox bar = bar_place(view.size, ticks);
  if (bar.y1 - bar.y0 < kLeastBar * size) return;  // no room
  const ColorMap map = color_map(view.color);
  const double line = std::max(1.0, std::round(0.07 * size));
  fill(image, bar.x0 - line, bar.y0 - line, bar.x1 + line, bar.y1 + line, [](int) { return kInk; });
  fill(image, bar.x0, bar.y0, bar.x1, bar.y1,
       [&](int y) { return map((bar.y1 - y - 0.5) / (bar.y1 - bar.y0)); });
  texts.keep_free({bar.x0 - line, bar.y0 - line, bar.x1 + line, bar.y1 + line});
  for (const auto& tick : ticks) {
    const double share = (tick.value - view.range[0]) / (view.range[1] - view.range[0]);
    const double y = bar.y1 - share * (bar.y1 - bar.y0);
    fill(image, bar.x1 + line, y - 0.5 * line, bar.x1 + line + 0.25 * size, y + 0.5 * line,
         [](int) { return kInk; });
    texts.put(tick.label, bar.x1 + 0.5 * size, std::round(y - 0.5 * kCapitalHeight * size), kInk);
  }
  const std::string title = about(view.color).word;
  const double end = image.width - 0.8 * size;
  const double wide = std::max(text_width(title, size), text_width(unit, size));
  const double left = std::min(bar.x0, end - wide);
  const double low = bar.y0 - 1.7 * size;  // the highest number stands half above the bar
  texts.put(unit, left, low, kInk);
  texts.put(title, left, unit.empty() ? low : low - kLine * size, kInk);
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
    const double value = without_minus_zero(i * step);
    const bool plain = largest < 1e7 && decimals <= 4;
    const int digits = 1 + static_cast<int>(std::floor(std::log10(largest / step) + 1e-9));
    ticks.push_back({value, plain ? fmt::format("{:.{}f}", value, decimals)
                                  : fmt::format("{:.{}e}", value, std::max(0, digits - 1))});
  }
  return ticks;
}

std::string time_text(double seconds) {
  if (seconds != 0 && std::abs(seconds) < 1e-3) return fmt::format("t = {:.2e} s", seconds);
  int decimals = 2;
  for (double scaled = seconds * 100; decimals < 6 && std::abs(scaled - std::round(scaled)) > 0.005;
       scaled *= 10)
    ++decimals;
  return fmt::format("t = {:.{}f} s", without_minus_zero(seconds), decimals);
}

std::string particles_text(std::int64_t count) {
  std::string digits = std::to_string(count);
  for (auto i = std::ssize(digits) - 3; i > 0; i -= 3) digits.insert(std::size_t(i), 1, ' ');
  return digits + (count == 1 ? " particle" : " particles");
}

double text_size(std::array<int, 2> picture) {
  return std::max(11.0, std::min(picture[1] / 38.0, picture[0] / 45.0));
}

TextBox bar_place(std::array<int, 2> picture, const std::vector<Tick>& ticks) {
  const double size = text_size(picture);
  double label = 0;
  for (const auto& tick : ticks) label = std::max(label, text_width(tick.label, size));
  const double x1 = picture[0] - 1.3 * size - label;
  const double low = 0.82 * picture[1];
  double above = (0.8 + 4 * kLine + 1.1) * size;  // name, time, title and unit
  if (low - above < kLeastBar * size) above = (0.8 + 2 * kLine + 0.6) * size;  // name and time
  return {std::round(x1 - size), std::round(std::max(0.25 * picture[1], above)), std::round(x1),
          std::round(low)};
}

Margins margins_of(const View& view) {
  const double size = text_size(view.size), width = view.size[0], height = view.size[1];
  const TextBox bar = bar_place(view.size, ticks_of(view.range));
  const double column = std::max(width - bar.x0, text_width(about(view.color).word, size));
  Margins margins{5.8 * size / width,  // there the numbers of an axis
                  (column + 4.2 * size) / width, (1.6 + 2 * kLine) * size / height,
                  2.6 * size / height};
  // In a picture of a few letters' size the fluid comes first.
  const double across = std::min(1.0, 0.5 / (margins.left + margins.right));
  const double along = std::min(1.0, 0.5 / (margins.top + margins.bottom));
  return {across * margins.left, across * margins.right, along * margins.top,
          along * margins.bottom};
}

void draw_overlay(Image& image, const View& view, const Projection& projection,
                  const std::string& unit, std::int64_t particles, double time) {
  const double size = text_size(view.size), margin = std::round(0.8 * size);
  Texts texts(image, size);
  texts.put(shortened(view.name, image.width - 2 * margin, size), margin, margin, kInk);
  const std::string when = time_text(time), all = when + "  ·  " + particles_text(particles);
  const bool whole = text_width(all, size) <= image.width - 2 * margin;
  texts.put(whole ? all : when, margin, std::round(margin + kLine * size), kFaintInk);
  draw_bar(image, texts, view, raised(unit));
  draw_lengths(image, texts, view, projection, size);
}

}  // namespace pbf::render_module
