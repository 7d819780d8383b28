#include "lib/render/grid.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

constexpr Rgb kGridLine{188, 197, 207};
constexpr double kOnFloor = 0.9999;  // nearer by less than what lies on the floor is high

constexpr std::size_t kHeights = 7;  // at most: a few say it

/// The unit in which a length is a number for people.
struct LengthUnit {
  const char* word;
  double metres;
};
LengthUnit unit_for(double longest) {
  if (longest < 1e-5) return {"µm", 1e-6};
  if (longest < 1e-2) return {"mm", 1e-3};
  if (longest >= 1e4) return {"km", 1e3};
  return {"m", 1};
}

/// Along which axis an edge runs, and a corner of the domain on it (bits as corner_of()).
struct Edge {
  unsigned axis, corner;
};

/// Those of the floor that are nearer to the eye; in two dimensions the lower and the left one. Not
/// at an open face, out of which fluid runs over them.
std::vector<Edge> edges_of(const View& view, const Projection& projection) {
  const auto vertical = static_cast<unsigned>(vertical_axis(view.up));
  const unsigned down = static_cast<unsigned>(view.up[vertical] < 0) << vertical;
  std::vector<Edge> edges;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (axis == (view.flat ? 1u : vertical)) continue;
    const unsigned other = 3 - axis - (view.flat ? 1 : vertical);
    const auto middle = [&](unsigned corner) {
      Double3 x = corner_of(view, corner);
      x[axis] = 0.5 * (view.domain_min[axis] + view.domain_max[axis]);
      return x;
    };
    // The corner of the slab's face to the viewer has y = min.
    const unsigned low = view.flat ? 0 : down, high = low | 1u << other;
    bool take_high = false;
    if (!view.flat) {
      take_high = length(middle(high) - projection.eye) < length(middle(low) - projection.eye);
    } else {
      const auto a = projection.to_pixel(middle(low)), b = projection.to_pixel(middle(high));
      take_high = axis == vertical ? b[0] < a[0] : b[1] > a[1];
    }
    if (!view.open[other][take_high]) edges.push_back({axis, take_high ? high : low});
  }
  return edges;
}

/// The vertical edge on the left of the box in the picture, else that on the right; none where both
/// lie at an open face. Nothing of the box is beyond them. Not in two dimensions.
std::optional<Edge> upright_edge(const View& view, const Projection& projection) {
  if (view.flat) return {};
  const auto vertical = static_cast<unsigned>(vertical_axis(view.up));
  const unsigned u = (vertical + 1) % 3, w = (vertical + 2) % 3;
  struct Place {
    double x;  // pixels
    Edge edge;
    bool open;
  };
  std::vector<Place> places;
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned corner = (i & 1) << u | (i >> 1) << w;
    Double3 middle = corner_of(view, corner);
    middle[vertical] = 0.5 * (view.domain_min[vertical] + view.domain_max[vertical]);
    if (projection.to_view(middle)[2] <= 0) return {};
    places.push_back({projection.to_pixel(middle)[0],
                      {vertical, corner},
                      view.open[u][i & 1] || view.open[w][i >> 1]});
  }
  const auto [left, right] = std::ranges::minmax_element(places, {}, &Place::x);
  if (!left->open) return left->edge;
  if (!right->open) return right->edge;
  return {};
}

/// Sizes of what labels and lines measure: the floor, or the framed part of the plane.
double longest_side(const View& view) {
  const Corners frame = frame_of(view);
  const Double3 &low = frame[0], &high = frame[7];
  const std::size_t without = view.flat ? 1 : vertical_axis(view.up);
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (k != without) longest = std::max(longest, high[k] - low[k]);
  return longest;
}

}  // namespace

double grid_step(double longest) {
  const double raw = longest / 10;
  int power = static_cast<int>(std::floor(std::log10(raw)));
  const double lead = raw / std::pow(10.0, power) * (1 - 1e-9);
  int first = lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10;
  if (first == 10) first = 1, ++power;
  return power < 0 ? first / std::pow(10.0, -power) : first * std::pow(10.0, power);
}

std::vector<double> multiples(double low, double high, double step) {
  std::vector<double> all;
  const double slack = 1e-6 * step;
  for (double n = std::ceil((low - slack) / step); n * step <= high + slack && all.size() < 1000;
       ++n)
    all.push_back(n == 0 ? 0.0 : n * step);
  return all;
}

void add_floor_grid(const View& view, const Projection& projection, double width, double near_depth,
                    std::vector<FlatVertex>& out) {
  if (!sees_floor(view, projection)) return;
  const std::size_t vertical = vertical_axis(view.up);
  const double step = grid_step(longest_side(view));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis == vertical) continue;
    const std::size_t other = 3 - axis - vertical;
    const double low = view.domain_min[axis], high = view.domain_max[axis];
    for (const double at : multiples(low, high, step)) {
      if (at < low + 0.01 * step || at > high - 0.01 * step) continue;  // the box has an edge there
      Double3 a = view.domain_min, b = view.domain_max;
      a[axis] = b[axis] = at;
      a[vertical] = b[vertical] =
          (view.up[vertical] > 0 ? view.domain_min : view.domain_max)[vertical];
      a[other] = view.domain_min[other], b[other] = view.domain_max[other];
      add_line(projection.to_view(a), projection.to_view(b), kGridLine, projection, width,
               near_depth, out, kOnFloor);
    }
  }
}

std::vector<EdgeLabels> length_labels(const View& view, const Projection& projection) {
  if (!view.flat && !sees_floor(view, projection)) return {};
  const double longest = longest_side(view);
  const LengthUnit unit = unit_for(longest);
  const Double3 box = view.domain_max - view.domain_min;
  const auto vertical = static_cast<unsigned>(vertical_axis(view.up));
  std::vector<Edge> edges = edges_of(view, projection);
  if (const auto edge = upright_edge(view, projection)) edges.push_back(*edge);
  std::vector<EdgeLabels> out;
  for (const auto& [axis, corner] : edges) {
    const bool upright = !view.flat && axis == vertical;
    // The default camera shows the floor whole, but not the air above the highest splash.
    const bool framed = upright && !view.camera.position;
    const double low = framed ? frame_of(view)[0][axis] : view.domain_min[axis];
    const double high = framed ? frame_of(view)[7][axis] : view.domain_max[axis];
    // Where the middle of the box is, seen from the edge.
    Double3 inwards{};
    for (unsigned k = 0; k < 3; ++k)
      if (k != axis && (upright || k != (view.flat ? 1 : vertical)))
        inwards[k] = (corner >> k & 1 ? -1e-3 : 1e-3) * (upright ? box[k] : length(box));
    double step = grid_step(longest);
    if (multiples(low, high, step).size() < 2) step = grid_step(high - low);
    const auto label = [&](double at) {
      LengthLabel l;
      Double3 x = corner_of(view, corner);
      x[axis] = at;
      const int decimals =
          std::max(0, static_cast<int>(-std::floor(std::log10(step / unit.metres) + 1e-9)));
      l.text = at == 0 ? "0" : fmt::format("{:.{}f}", at / unit.metres, std::min(decimals, 12));
      if (projection.to_view(x)[2] <= 1e-6 * length(box)) return LengthLabel{};
      l.place = projection.to_pixel(x);
      const auto further = projection.to_pixel(x - inwards);
      // Beside an upright edge, at the height of its place.
      const double dx = further[0] - l.place[0], dy = upright ? 0 : further[1] - l.place[1];
      const double size = std::hypot(dx, dy);
      if (!(size > 0) || !std::isfinite(size)) return LengthLabel{};
      l.away = {dx / size, dy / size};
      return l;
    };
    EdgeLabels edge;
    edge.ticks = view.flat || upright;
    edge.axis = "xyz"[axis];
    edge.unit = unit.word;
    const auto add = [&](const std::vector<double>& places) {
      std::vector<LengthLabel> labels;
      for (const double at : places) {
        LengthLabel l = label(at);
        if (!l.text.empty()) labels.push_back(std::move(l));
      }
      edge.of.push_back(std::move(labels));
    };
    int factor = 1;
    for (int k = 0; multiples(low, high, factor * step).size() >= 2; ++k) {
      const auto places = multiples(low, high, factor * step);
      if (!upright || places.size() <= kHeights) add(places);
      factor = k % 3 == 1 ? factor / 2 * 5 : 2 * factor;  // 1, 2, 5, 10, 20, 50 ...
    }
    out.push_back(std::move(edge));
  }
  return out;
}

}  // namespace pbf::render_module
