#include "lib/render/box.h"

#include <cmath>
#include <utility>

#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

constexpr Rgb kEdge{92, 102, 116}, kFloor{218, 224, 230};

// The floor is farther by this one: obstacles that lie on it win.
constexpr double kFarther = 1.0003;

void add_quad(const std::array<FlatVertex, 4>& q, std::vector<FlatVertex>& out) {
  for (std::size_t i : {0, 1, 2, 2, 1, 3}) out.push_back(q[i]);
}

}  // namespace

void add_line(Double3 a, Double3 b, Rgb color, const Projection& projection, double width,
              double near_depth, std::vector<FlatVertex>& out, double nearer) {
  if (a[2] > b[2]) std::swap(a, b);
  if (b[2] <= near_depth) return;
  if (a[2] < near_depth) a = a + (near_depth - a[2]) / (b[2] - a[2]) * (b - a);
  // Direction in the picture; an edge seen end-on has none, and is a dot of the line's width.
  double dx = b[0] / b[2] - a[0] / a[2], dy = b[1] / b[2] - a[1] / a[2];
  const double size = std::hypot(dx, dy);
  if (size > 0)
    dx /= size, dy /= size;
  else
    dx = 1;
  const double half = 0.5 * width * projection.pixel();  // per unit of depth
  const auto moved = [&](const Double3& p, double along, double aside) {
    const double s = half * p[2];
    const Double3 place{p[0] + s * (along * dx - aside * dy), p[1] + s * (along * dy + aside * dx),
                        p[2]};
    return FlatVertex{floats(nearer * place), color};
  };
  add_quad({moved(a, -1, -1), moved(a, -1, 1), moved(b, 1, -1), moved(b, 1, 1)}, out);
}

void add_box_edges(const View& view, const Projection& projection, double width, double near_depth,
                   std::vector<FlatVertex>& out) {
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned from = 0; from < 8; ++from) {
      if (from >> axis & 1) continue;
      if (view.flat && (axis == 1 || from >> 1 & 1)) continue;  // the nearer face alone
      add_line(projection.to_view(corner_of(view, from)),
               projection.to_view(corner_of(view, from | 1u << axis)), kEdge, projection, width,
               near_depth, out);
    }
}

bool floor_is_open(const View& view) {
  const std::size_t k = vertical_axis(view.up);
  return view.open[k][view.up[k] < 0];
}

bool sees_floor(const View& view, const Projection& projection) {
  const std::size_t k = vertical_axis(view.up);
  if (view.flat || floor_is_open(view)) return false;
  return view.up[k] > 0 ? projection.eye[k] > view.domain_min[k]
                        : projection.eye[k] < view.domain_max[k];
}

void add_floor(const View& view, const Projection& projection, std::vector<FlatVertex>& out) {
  if (!sees_floor(view, projection)) return;
  const auto vertical = static_cast<unsigned>(vertical_axis(view.up));
  const unsigned u = (vertical + 1) % 3, w = (vertical + 2) % 3;
  std::array<FlatVertex, 4> quad;
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned bits =
        (i & 1) << u | (i >> 1) << w | static_cast<unsigned>(view.up[vertical] < 0) << vertical;
    quad[i] = {floats(kFarther * projection.to_view(corner_of(view, bits))), kFloor};
  }
  add_quad(quad, out);
}

}  // namespace pbf::render_module
