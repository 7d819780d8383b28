#include "lib/verify/compare_picture.h"

#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/render/font.h"
#include "lib/verify/diagram_scale.h"

namespace pbf::inline verify_module {
namespace {

constexpr Rgb kInk{31, 41, 55}, kGrey{214, 218, 224}, kGood{22, 163, 74}, kBad{220, 38, 38};
constexpr Rgb kCurves[] = {{37, 99, 235}, {147, 180, 245}, {217, 119, 6}};

/// With what the font has.
std::string plain(std::string s) {
  for (const char c : {'`', '"'}) std::erase(s, c);
  for (const auto& [from, to] : {std::pair{';', ','}, {'[', '('}, {']', ')'}})
    std::replace(s.begin(), s.end(), from, to);
  return s;
}

void box(Image& image, double x0, double y0, double x1, double y1, Rgb color) {
  const auto edge = [](double v, int end) { return std::clamp(int(std::lround(v)), 0, end); };
  for (int y = edge(y0, image.height); y < edge(y1, image.height); ++y)
    for (int x = edge(x0, image.width); x < edge(x1, image.width); ++x)
      std::copy(color.begin(), color.end(),
                image.rgb.begin() + 3 * (std::ptrdiff_t(y) * image.width + x));
}

void line(Image& image, double x0, double y0, double x1, double y1, Rgb color) {
  const int steps = 1 + int(std::max(std::fabs(x1 - x0), std::fabs(y1 - y0)));
  for (int k = 0; k <= steps; ++k) {
    const double t = double(k) / steps, x = x0 + t * (x1 - x0), y = y0 + t * (y1 - y0);
    box(image, x - 1, y - 1, x + 1, y + 1, color);
  }
}

void draw_diagram(Image& image, const Diagram& d, double x, double y, double w, double h) {
  DiagramScale s = diagram_scale(d, w, h, 1.2);
  const auto px = [&](double v) { return x + s.x(v); };
  const auto py = [&](double v) { return y + s.y(v); };
  draw_text(image, d.title, x + s.left, y, 2, kInk);
  draw_text(image, d.y_label, x + s.left, y + 24, 1.6, kInk);
  for (const auto& [value, label] : s.y_ticks) {
    box(image, x + s.left, py(value), x + s.right, py(value) + 1, kGrey);
    draw_text(image, label, x + s.left - 8 - text_width(label, 1.6), py(value) - 5, 1.6, kInk);
  }
  for (const auto& [value, label] : s.x_ticks)
    draw_text(image, label, px(value) - text_width(label, 1.6) / 2, y + s.bottom + 8, 1.6, kInk);
  draw_text(image, d.x_label, x + s.right - text_width(d.x_label, 1.6), y + s.bottom + 26, 1.6,
            kInk);
  for (std::size_t c = 0; c < d.curves.size(); ++c) {
    const Curve& curve = d.curves[c];
    const Rgb color = kCurves[c % std::size(kCurves)];
    const auto drawn = [&](std::size_t k) { return curve.y[k] > 0 && std::isfinite(curve.y[k]); };
    for (std::size_t k = 1; k < curve.x.size(); ++k)
      if (drawn(k - 1) && drawn(k))
        line(image, px(curve.x[k - 1]), py(curve.y[k - 1]), px(curve.x[k]), py(curve.y[k]), color);
    draw_text(image, curve.name, x + s.right - 190, y + s.bottom - 22 - 18 * double(c), 1.6, color);
  }
}

/// A bar per row: log10 of the error's share of its tolerance, from 1e-4 to 1e4.
void draw_bars(Image& image, const ComparePart& part, double x, double y, double w, double h) {
  draw_text(image, part.name + ": error / tolerance", x, y, 2, kInk);
  const double left = x + 190, right = x + w, top = y + 26;
  const double pitch =
      std::min(20.0, (h - 46) / double(std::max<std::size_t>(part.rows.size(), 1)));
  const double dot = std::min(1.6, pitch / 9);
  const auto place = [&](double share) {
    return left + (std::clamp(std::log10(share), -4.0, 4.0) + 4) / 8 * (right - left);
  };
  const double bottom = top + pitch * double(part.rows.size());
  for (int p = -4; p <= 4; p += 2) {
    const double at = place(std::pow(10.0, p));
    box(image, at, top, at + (p == 0 ? 2 : 1), bottom, p == 0 ? kInk : kGrey);
    const std::string label = p == 0 ? std::string("1") : format("1e%d", p);
    draw_text(image, label, at - text_width(label, 1.5) / 2, bottom + 6, 1.5, kInk);
  }
  for (std::size_t k = 0; k < part.rows.size(); ++k) {
    const CompareRow& r = part.rows[k];
    const double at = top + pitch * double(k);
    draw_text(image, r.what, x, at + pitch / 2 - 3.5 * dot, dot, kInk);
    const double share = r.error == 0 ? 1e-4 : r.tolerance > 0 ? r.error / r.tolerance : 1e4;
    box(image, left, at + 0.2 * pitch, place(share), at + 0.8 * pitch,
        r.verdict == Verdict::differs ? kBad : kGood);
  }
}

}  // namespace

Image compare_picture(const CompareResult& r) {
  Image image{1280, 800, std::vector<std::uint8_t>(std::size_t(3) * 1280 * 800, 255)};
  draw_text(image, r.same() ? "same" : "DIFFERENT" + (r.stage.empty() ? "" : ", stage " + r.stage),
            24, 20, 3, r.same() ? kGood : kBad);
  draw_text(image, plain("A  " + r.a), 24, 54, 1.8, kInk);
  draw_text(image, plain("B  " + r.b), 24, 74, 1.8, kInk);
  for (std::size_t k = 0; k < r.notes.size() && k < 2; ++k)
    draw_text(image, plain(r.notes[k]), 24, 94 + 18 * double(k), 1.5, kInk);
  const ComparePart* bars = nullptr;
  double y = 470;
  for (const ComparePart& p : r.parts) {
    if (!p.rows.empty() && !bars) bars = &p;
    draw_text(image, p.name + ": " + verdict_name(p.verdict), 664, y, 2,
              p.verdict == Verdict::differs ? kBad : kInk);
    std::string rest = plain(p.finding);
    for (y += 22; !rest.empty(); y += 18) {
      std::size_t end = rest.size();
      while (text_width(rest.substr(0, end), 1.5) > 590) end = rest.rfind(' ', end - 1);
      draw_text(image, rest.substr(0, end), 664, y, 1.5, kInk);
      rest.erase(0, end + (end < rest.size() ? 1 : 0));
    }
    y += 14;
  }
  if (bars) draw_bars(image, *bars, 24, 140, 590, 650);
  if (!r.diagrams.empty()) draw_diagram(image, r.diagrams[0], 640, 130, 640, 320);
  return image;
}

}  // namespace pbf::inline verify_module
