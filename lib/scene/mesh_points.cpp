// Lattice points in a mesh. Lines along x through the lattice enter and leave it where they cross
// triangles. Whether a line crosses a triangle is decided at the edges of its projection to the y-z
// plane, for each edge in the same way for both triangles that have it, and for a line through an
// edge or a vertex as if it were beside it: up by e in y and e^2 in z, e -> 0. So a line crosses a
// closed surface as often inwards as outwards.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lib/scene/triangle_mesh.h"

namespace pbf::scene_module {
namespace {

/// Above 0 if the line at (y, z) is to the left of the projected edge from a to b, below 0 if to
/// the right; 0 only if the projected edge is a point.
double side_of(const Double3& a, const Double3& b, double y, double z) {
  const double dy = b[1] - a[1], dz = b[2] - a[2];
  const double side = dy * (z - a[2]) - dz * (y - a[1]);
  if (side != 0) return side;
  return dz != 0 ? (dz < 0 ? 1e-300 : -1e-300) : dy > 0 ? 1e-300 : dy < 0 ? -1e-300 : 0;
}

/// Adds the crossing of triangle t with the line at (y, z), if there is one.
void cross_one(const TriangleMesh& mesh, std::size_t t, double y, double z,
               std::vector<Crossing>& to) {
  double side[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t a = mesh.triangle[t][k], b = mesh.triangle[t][(k + 1) % 3];
    const Double3 &p = mesh.vertex[std::size_t(std::min(a, b))],
                  &q = mesh.vertex[std::size_t(std::max(a, b))];
    side[k] = a < b ? side_of(p, q, y, z) : -side_of(p, q, y, z);
  }
  const bool left = side[0] > 0 && side[1] > 0 && side[2] > 0;
  const bool right = side[0] < 0 && side[1] < 0 && side[2] < 0;
  if (!left && !right) return;
  // The weight of a corner is the area on the other side of its opposite edge.
  const double sum = side[0] + side[1] + side[2];
  const double x = (side[1] * mesh.corner(t, 0)[0] + side[2] * mesh.corner(t, 1)[0] +
                    side[0] * mesh.corner(t, 2)[0]) /
                   sum;
  to.push_back({x, left ? -1 : 1});  // left: the normal points along x
}

/// Lattice coordinates low + (i + 1/2) d, i < n.
struct Axis {
  double low, d;
  std::int64_t n;
  double at(std::int64_t i) const { return low + (double(i) + 0.5) * d; }
  std::int64_t first_from(double x) const {
    return std::int64_t(std::clamp(std::ceil((x - low) / d - 0.5), 0.0, double(n)));
  }
};

int total(const std::vector<Crossing>& line) {
  int sum = 0;
  for (const Crossing& c : line) sum += c.winding;
  return sum;
}

}  // namespace

std::vector<Crossing> crossings(const TriangleMesh& mesh, const std::vector<std::int32_t>& among,
                                double y, double z, double d) {
  std::vector<Crossing> line;
  // Rounding near a vertex, where edges meet, may count one crossing too many.
  for (int tries = 0; tries <= 8; ++tries) {
    line.clear();
    for (const std::int32_t t : among)
      cross_one(mesh, std::size_t(t), y + 1e-7 * tries * d, z + 0.6e-7 * tries * d, line);
    if (total(line) == 0) break;
  }
  std::ranges::sort(line, {}, &Crossing::x);
  return line;
}

std::vector<Double3> points_in(const TriangleMesh& mesh, double d, std::optional<double> plane) {
  const auto [low, high] = box_of(mesh);
  const auto axis = [&, &low = low, &high = high](std::size_t a) {
    return Axis{low[a], d, std::int64_t(std::ceil((high[a] - low[a]) / d - 1e-6))};
  };
  const Axis x = axis(0), z = axis(2);
  const Axis y = plane ? Axis{*plane - 0.5 * d, d, 1} : axis(1);
  std::vector<std::vector<std::int32_t>> near(std::size_t(y.n * z.n));  // by line
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    double least[3] = {1e300, 1e300, 1e300}, most[3] = {-1e300, -1e300, -1e300};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t a = 1; a < 3; ++a) {
        least[a] = std::min(least[a], mesh.corner(t, k)[a]);
        most[a] = std::max(most[a], mesh.corner(t, k)[a]);
      }
    const double slack = 1e-5 * d;  // crossings() may move the line
    for (std::int64_t k = z.first_from(least[2] - slack); k < z.n && z.at(k) <= most[2] + slack;
         ++k)
      for (std::int64_t j = y.first_from(least[1] - slack); j < y.n && y.at(j) <= most[1] + slack;
           ++j)
        near[std::size_t(k * y.n + j)].push_back(std::int32_t(t));
  }
  std::vector<Double3> points;
  for (std::int64_t k = 0; k < z.n; ++k)
    for (std::int64_t j = 0; j < y.n; ++j) {
      const std::vector<Crossing> mine =
          crossings(mesh, near[std::size_t(k * y.n + j)], y.at(j), z.at(k), d);
      int inside = 0;
      auto next = mine.begin();
      for (std::int64_t i = 0; i < x.n; ++i) {
        for (; next != mine.end() && next->x <= x.at(i); ++next) inside += next->winding;
        if (inside > 0) points.push_back({x.at(i), plane ? *plane : y.at(j), z.at(k)});
      }
    }
  return points;
}

}  // namespace pbf::scene_module
