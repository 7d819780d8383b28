#include "lib/render/overlay.h"

#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/render/font.h"
#include "lib/render/grid.h"

namespace pbf::inline render_module {
namespace {

constexpr Rgb kInk{42, 48, 58}, kFaintInk{92, 102, 116}, kHalo{246, 248, 250};
constexpr double kLine = 1.4;  // from one line of text to the next, in sizes of the text

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

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// Texts of one size on a picture, none over another.
class Texts {
 public:
  Texts(Image& image, double size) : image_(image), size_(size) {}

  void keep_free(const Box& box) { taken_.push_back(box); }
  /// The room of a text whose capitals' top left corner is at (x, y).
  Box box_of(const std::string& text, double x, double y) const {
    return {x, y - 0.28 * size_, x + text_width(text, size_),
            y + (kCapitalHeight + kDescent) * size_};
  }
  bool fits(const Box& box) const {
    return box.x0 >= 0 && box.y0 >= 0 && box.x1 <= image_.width && box.y1 <= image_.height &&
           std::none_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(box); });
  }
  /// Draws it where it fits.
  void put(const std::string& text, double x, double y, Rgb color) {
    const Box box = box_of(text, x, y);
    if (text.empty() || !fits(box)) return;
    taken_.push_back(box);
    // Also on fluid it is read.
    const double r = std::max(1.0, 0.06 * size_);
    for (const auto& [dx, dy] : {std::array{-r, 0.0}, {r, 0.0}, {0.0, -r}, {0.0, r}})
      draw_text(image_, text, x + dx, y + dy, size_, kHalo);
    draw_text(image_, text, x, y, size_, color);
  }

 private:
  Image& image_;
  double size_;
  std::vector<Box> taken_;
};

/// m/s, kg/m^3 -> kg/m³
std::string raised(std::string unit) {
  for (const auto& [from, to] : {std::array{"^2", "²"}, {"^3", "³"}})
    if (const auto at = unit.find(from); at != std::string::npos) unit.replace(at, 2, to);
  return unit;
}

void draw_bar(Image& image, Texts& texts, const View& view, const std::string& unit) {
  const auto ticks = ticks_of(view.range);
  const double size = text_size(view.size);
  const BarPlace bar = bar_place(view.size, ticks);
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
  const double low = bar.y0 - (kCapitalHeight + 0.6) * size;
  texts.put(unit, left, low, kInk);
  texts.put(title, left, unit.empty() ? low : low - kLine * size, kInk);
}

/// Where a label's text begins: beside the place, out of the box.
std::array<double, 2> start_of(const LengthLabel& label, double size) {
  const double wide = 0.5 * text_width(label.text, size), high = 0.5 * kCapitalHeight * size;
  const double off = 0.5 * size + std::abs(label.away[0]) * wide + std::abs(label.away[1]) * high;
  return {label.place[0] + off * label.away[0] - wide, label.place[1] + off * label.away[1] - high};
}

void draw_lengths(Image& image, Texts& texts, const View& view, const Projection& projection) {
  const double size = text_size(view.size);
  for (const EdgeLabels& edge : length_labels(view, projection)) {
    // As many as keep a distance from each other.
    const auto* chosen = edge.of.empty() ? nullptr : &edge.of.back();
    for (const auto& labels : edge.of) {
      bool apart = true;
      std::vector<Box> boxes;
      for (const LengthLabel& l : labels) {
        const auto [x, y] = start_of(l, size);
        Box box = texts.box_of(l.text, x, y);
        box.x0 -= 0.5 * size, box.x1 += 0.5 * size;
        for (const Box& other : boxes) apart = apart && !box.meets(other);
        boxes.push_back(box);
      }
      if (!apart) continue;
      chosen = &labels;
      break;
    }
    if (!chosen) continue;
    for (const LengthLabel& l : *chosen) {
      const auto [x, y] = start_of(l, size);
      if (view.flat && texts.fits(texts.box_of(l.text, x, y))) {
        const double line = std::max(1.0, std::round(0.07 * size));
        const double to_x = l.place[0] + 0.3 * size * l.away[0],
                     to_y = l.place[1] + 0.3 * size * l.away[1];
        fill(image, std::min(l.place[0], to_x) - 0.5 * line,
             std::min(l.place[1], to_y) - 0.5 * line, std::max(l.place[0], to_x) + 0.5 * line,
             std::max(l.place[1], to_y) + 0.5 * line, [](int) { return kFaintInk; });
      }
      texts.put(l.text, x, y, kFaintInk);
    }
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

std::string particles_text(std::int64_t count) {
  const std::string digits = std::to_string(count);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += ' ';
    out += digits[i];
  }
  return out + (count == 1 ? " particle" : " particles");
}

double text_size(std::array<int, 2> picture) {
  return std::max(11.0, std::min(picture[1] / 38.0, picture[0] / 45.0));
}

BarPlace bar_place(std::array<int, 2> picture, const std::vector<Tick>& ticks) {
  const double size = text_size(picture);
  double label = 0;
  for (const auto& tick : ticks) label = std::max(label, text_width(tick.label, size));
  const double x1 = picture[0] - 1.3 * size - label;
  const double above = 0.8 * size + 4 * kLine * size;  // name, time, title and unit
  return {std::round(x1 - size), std::round(std::max(0.25 * picture[1], above + 0.6 * size)),
          std::round(x1), std::round(0.82 * picture[1])};
}

Room room_of(const View& view) {
  const double size = text_size(view.size), width = view.size[0], height = view.size[1];
  const BarPlace bar = bar_place(view.size, ticks_of(view.range));
  const double column = std::max(width - bar.x0, text_width(about(view.color).word, size));
  Room room{3.2 * size / width, (column + 3.2 * size) / width, (1.6 + 2 * kLine) * size / height,
            2.6 * size / height};
  // In a picture of a few letters' size the fluid comes first.
  const double across = std::min(1.0, 0.5 / (room.left + room.right));
  const double along = std::min(1.0, 0.5 / (room.top + room.bottom));
  return {across * room.left, across * room.right, along * room.top, along * room.bottom};
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
  draw_lengths(image, texts, view, projection);
}

}  // namespace pbf::inline render_module
