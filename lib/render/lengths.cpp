// The labels of lengths on a picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "lib/render/grid.h"

namespace pbf::render_module {
namespace {

/// Corners of the frame in the picture, in the order of a convex outline; empty where it cannot be
/// told, for one is behind the eye.
using Outline = std::vector<std::array<double, 2>>;

Outline outline_of(const View& view, const Projection& projection) {
  Outline corners;
  for (const Double3& corner : frame_of(view)) {
    if (projection.to_view(corner)[2] <= 0) return {};
    corners.push_back(projection.to_pixel(corner));
  }
  std::ranges::sort(corners);
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
    std::ranges::reverse(corners);
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

/// Axis and unit of an edge: beyond its last number, else beside the middle of its numbers; where
/// there is no room, the unit alone behind the last number.
void put_name(Texts& texts, const EdgeLabels& edge, const std::vector<LengthLabel>& labels,
              const Outline& outline, double size) {
  const LengthLabel &first = labels.front(), &last = labels.back();
  const std::string name = edge.axis + " (" + edge.unit + ")";
  const double dx = last.place[0] - first.place[0], dy = last.place[1] - first.place[1];
  const double way = std::max(1e-9, std::hypot(dx, dy));
  const auto put = [&](LengthLabel l) {
    const auto [x, y] = start_of(l, outline, size);
    const TextBox box = texts.box_of(l.text, x, y);
    if (!texts.fits({box.x0 - 0.4 * size, box.y0, box.x1 + 0.4 * size, box.y1}) ||
        !is_beside(box, outline))
      return false;
    texts.put(l.text, x, y, kFaintInk);
    return true;
  };
  for (double off = size; off <= 4 * size; off += 0.25 * size)
    if (put({name, {last.place[0] + off * dx / way, last.place[1] + off * dy / way}, last.away}))
      return;
  for (double off = size; off <= 4 * size; off += 0.25 * size)
    if (put({name,
             {first.place[0] + 0.5 * dx + off * last.away[0],
              first.place[1] + 0.5 * dy + off * last.away[1]},
             last.away}))
      return;
  const auto [x, y] = start_of(last, outline, size);
  texts.put(edge.unit, x + text_width(last.text, size) + 0.3 * size, y, kFaintInk);
}

}  // namespace

void draw_lengths(Image& image, Texts& texts, const View& view, const Projection& projection,
                  double size) {
  const Outline outline = outline_of(view, projection);
  const std::vector<EdgeLabels> edges = length_labels(view, projection);
  std::vector<std::pair<const EdgeLabels*, std::vector<LengthLabel>>> drawn;
  for (const EdgeLabels& edge : edges) {
    // As many as keep a distance from each other; none where no two do.
    const std::vector<LengthLabel>* chosen = nullptr;
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
    auto& shown = drawn.emplace_back(&edge, std::vector<LengthLabel>{}).second;
    for (const LengthLabel& l : *chosen) {
      const auto [x, y] = start_of(l, outline, size);
      if (!fitting(l)) continue;
      shown.push_back(l);
      if (edge.ticks) {
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
  for (const auto& [edge, shown] : drawn)  // numbers come first
    if (!shown.empty()) put_name(texts, *edge, shown, outline, size);
}

}  // namespace pbf::render_module
