#include "lib/render/overlay.h"

#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/render/font.h"
#include "lib/render/grid.h"

namespace pbf::inline render_module {
namespace {

constexpr Rgb kInk{42, 48, 58}, kFaintInk{92, 102, 116}, kHalo{246, 248, 250};
constexpr double kLine = 1.4;    // from one line of text to the next, in sizes of the text
constexpr double kLeastBar = 4;  // height of a colour bar, in sizes of the text

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

/// Pixels.
struct TextBox {
  double x0, y0, x1, y1;
  bool meets(const TextBox& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// Texts of one size on a picture, none over another.
class Texts {
 public:
  Texts(Image& image, double size) : image_(image), size_(size) {}

  void keep_free(const TextBox& box) { taken_.push_back(box); }
  /// The room of a text whose capitals' top left corner is at (x, y).
  TextBox box_of(const std::string& text, double x, double y) const {
    return {x, y - 0.28 * size_, x + text_width(text, size_),
            y + (kCapitalHeight + kDescent) * size_};
  }
  bool fits(const TextBox& box) const {
    return box.x0 >= 0 && box.y0 >= 0 && box.x1 <= image_.width && box.y1 <= image_.height &&
           std::none_of(taken_.begin(), taken_.end(),
                        [&](const TextBox& b) { return b.meets(box); });
  }
  /// Draws it where it fits.
  void put(const std::string& text, double x, double y, Rgb color) {
    const TextBox box = box_of(text, x, y);
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
  std::vector<TextBox> taken_;
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

/// Corners of the frame in the picture, in the order of a convex outline; empty where it cannot be
/// told, for one is behind the eye.
using Outline = std::vector<std::array<double, 2>>;

Outline outline_of(const View& view, const Projection& projection) {
  Outline corners;
  for (const Double3& corner : frame_of(view)) {
    if (projection.to_view(corner)[2] <= 0) return {};
    corners.push_back(projection.to_pixel(corner));
  }
  std::sort(corners.begin(), corners.end());
  Outline hull;  // Andrew's monotone chain
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const auto& p : corners) {
      while (hull.size() >= start + 2) {
        const auto &a = hull[hull.size() - 2], &b = hull.back();
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(corners.begin(), corners.end());
  }
  return hull;
}

/// Whether a line along one of the outline's sides has the box behind it; its axes count too.
bool is_beside(const TextBox& box, const Outline& outline) {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    x0 = std::min(x0, a[0]), x1 = std::max(x1, a[0]);
    y0 = std::min(y0, a[1]), y1 = std::max(y1, a[1]);
    bool beyond = true;
    for (const double x : {box.x0, box.x1})
      for (const double y : {box.y0, box.y1})
        beyond = beyond && (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) <= 0;
    if (beyond) return true;
  }
  return box.x1 <= x0 || box.x0 >= x1 || box.y1 <= y0 || box.y0 >= y1;
}

/// Where a label's text begins: beside the place, out of the box, and beside the frame where a
/// short way leads there.
std::array<double, 2> start_of(const LengthLabel& label, const Outline& outline, double size) {
  const double wide = 0.5 * text_width(label.text, size), high = 0.5 * kCapitalHeight * size;
  const double near = 0.5 * size + std::abs(label.away[0]) * wide + std::abs(label.away[1]) * high;
  const auto start = [&](double off) {
    return std::array{label.place[0] + off * label.away[0] - wide,
                      label.place[1] + off * label.away[1] - high};
  };
  for (int k = 0; k < 16; ++k) {
    const auto [x, y] = start(near + 0.25 * k * size);
    const TextBox box{x - 0.4 * size, y, x + 2 * wide + 0.4 * size, y + 2 * high};
    if (is_beside(box, outline)) return {x, y};
  }
  return start(near);
}

void draw_lengths(Image& image, Texts& texts, const View& view, const Projection& projection) {
  const double size = text_size(view.size);
  const Outline outline = outline_of(view, projection);
  for (const EdgeLabels& edge : length_labels(view, projection)) {
    // As many as keep a distance from each other.
    const auto* chosen = edge.of.empty() ? nullptr : &edge.of.back();
    for (const auto& labels : edge.of) {
      bool apart = true;
      std::vector<TextBox> boxes;
      for (const LengthLabel& l : labels) {
        const auto [x, y] = start_of(l, outline, size);
        TextBox box = texts.box_of(l.text, x, y);
        box.x0 -= 0.5 * size, box.x1 += 0.5 * size;
        for (const TextBox& other : boxes) apart = apart && !box.meets(other);
        boxes.push_back(box);
      }
      if (!apart) continue;
      chosen = &labels;
      break;
    }
    const auto fitting = [&](const LengthLabel& l) {
      const auto [x, y] = start_of(l, outline, size);
      return texts.fits(texts.box_of(l.text, x, y));
    };
    // One number alone measures nothing.
    if (!chosen || std::count_if(chosen->begin(), chosen->end(), fitting) < 2) continue;
    for (const LengthLabel& l : *chosen) {
      const auto [x, y] = start_of(l, outline, size);
      if (view.flat && fitting(l)) {
        const double line = std::max(1.0, std::round(0.07 * size));
        const double to_x = l.place[0] + 0.3 * size * l.away[0],
                     to_y = l.place[1] + 0.3 * size * l.away[1];
        fill(image, std::min(l.place[0], to_x) - 0.5 * line,
             std::min(l.place[1], to_y) - 0.5 * line, std::max(l.place[0], to_x) + 0.5 * line,
             std::max(l.place[1], to_y) + 0.5 * line, [](int) { return kFaintInk; });
      }
      texts.put(l.text, x, y, kInk);
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
  const double low = 0.82 * picture[1];
  double above = (0.8 + 4 * kLine + 1.1) * size;  // name, time, title and unit
  if (low - above < kLeastBar * size) above = (0.8 + 2 * kLine + 0.6) * size;  // name and time
  return {std::round(x1 - size), std::round(std::max(0.25 * picture[1], above)), std::round(x1),
          std::round(low)};
}

Room room_of(const View& view) {
  const double size = text_size(view.size), width = view.size[0], height = view.size[1];
  const BarPlace bar = bar_place(view.size, ticks_of(view.range));
  const double column = std::max(width - bar.x0, text_width(about(view.color).word, size));
  const double beside = view.flat ? 5.8 : 3.2;  // there the numbers of an axis
  Room room{beside * size / width, (column + 4.2 * size) / width, (1.6 + 2 * kLine) * size / height,
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
