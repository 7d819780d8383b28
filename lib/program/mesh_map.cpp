#include "lib/program/mesh_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lib/program/mesh_share.h"

namespace pbf::program_module {
namespace {

constexpr double kEdge = 0.25;
/// The first node is off the corner of the box by this part of a cell, so that no node is on a face
/// along the grid, where inside and outside would be a matter of rounding.
constexpr double kOff = 0.37;
constexpr int kAcross = kMapCells + 1;

/// From x to the triangle (Ericson 2005, "Real-Time Collision Detection", 5.1.5), squared.
double distance_squared(const Double3& x, const Double3& a, const Double3& b, const Double3& c) {
  const Double3 ab = b - a, ac = c - a, ap = x - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  const auto to = [&](const Double3& p) { return dot(x - p, x - p); };
  if (d1 <= 0 && d2 <= 0) return to(a);
  const Double3 bp = x - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return to(b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(a + (d1 / (d1 - d3)) * ab);
  const Double3 cp = x - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return to(c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(a + (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return to(b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
  const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
  return to(a + v * ab + w * ac);
}

class Builder {
 public:
  Builder(const TriangleMesh& mesh, double range, double reach)
      : mesh_(mesh), range_(range), band_(std::max(range, reach) + 2 * kEdge) {
    const auto [low, high] = box_of(mesh);
    out_.map.box = {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    out_.map.edge = kEdge;
    out_.map.band = std::max(range, reach);
    for (std::size_t a = 0; a < 3; ++a) {
      origin_[a] = low[a] - band_ - kOff * kEdge;
      bricks_[a] = int(std::ceil((high[a] + band_ - origin_[a]) / (kEdge * kMapCells)));
      out_.map.bricks[a] = bricks_[a];
    }
    out_.map.origin = {origin_[0], origin_[1], origin_[2]};
  }

  MeshMap make() {
    find_near();
    out_.brick.assign(near_.size(), map_outside);
    int stored = 0;
    for (std::size_t b = 0; b < near_.size(); ++b)
      if (!near_[b].empty()) out_.brick[b] = stored++;
    out_.shares.resize(std::size_t(stored) * kMapNodes);
    out_.away.resize(std::size_t(stored) * kMapNodes);
    const int rows = bricks_[1] * bricks_[2];
#pragma omp parallel for schedule(dynamic)
    for (int row = 0; row < rows; ++row) make_row(row);
    return std::move(out_);
  }

 private:
  double at(std::size_t axis, int node) const { return origin_[axis] + kEdge * node; }

  /// The triangles within the band of each brick.
  void find_near() {
    near_.resize(std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]));
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) {
      const Double3 center =
          (1.0 / 3) * (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2));
      double radius = 0;
      for (std::size_t k = 0; k < 3; ++k)
        radius = std::max(radius, length(mesh_.corner(t, k) - center));
      ball_.push_back({center, radius, std::int32_t(t)});
      std::array<int, 3> first{}, last{};
      for (std::size_t a = 0; a < 3; ++a) {
        const double low = std::min(
                         {mesh_.corner(t, 0)[a], mesh_.corner(t, 1)[a], mesh_.corner(t, 2)[a]}),
                     high = std::max(
                         {mesh_.corner(t, 0)[a], mesh_.corner(t, 1)[a], mesh_.corner(t, 2)[a]});
        const auto brick = [&](double x) {
          return std::clamp(int(std::floor((x - origin_[a]) / (kEdge * kMapCells))), 0,
                            bricks_[a] - 1);
        };
        first[a] = brick(low - band_), last[a] = brick(high + band_);
      }
      const double half = 0.5 * kEdge * kMapCells, round = std::sqrt(3.0) * half + band_;
      for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
          for (int i = first[0]; i <= last[0]; ++i) {
            const Double3 middle{at(0, i * kMapCells) + half, at(1, j * kMapCells) + half,
                                 at(2, k * kMapCells) + half};
            if (distance_squared(middle, mesh_.corner(t, 0), mesh_.corner(t, 1),
                                 mesh_.corner(t, 2)) < round * round)
              near_[brick_at(i, j, k)].push_back(std::int32_t(t));
          }
    }
  }
  std::size_t brick_at(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(bricks_[1]) + std::size_t(j)) * std::size_t(bricks_[0]) +
           std::size_t(i);
  }

  /// A row of bricks along x: lines through its nodes tell what is inside.
  void make_row(int row) {
    const int j = row % bricks_[1], k = row / bricks_[1];
    std::vector<std::int32_t> all;
    for (int i = 0; i < bricks_[0]; ++i) {
      const auto& some = near_[brick_at(i, j, k)];
      all.insert(all.end(), some.begin(), some.end());
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (all.empty()) return;  // outside: a body has a surface on each line
    std::vector<bool> inside(std::size_t(bricks_[0] * kMapCells + 1));
    for (int z = 0; z < kAcross; ++z)
      for (int y = 0; y < kAcross; ++y) {
        const double py = at(1, j * kMapCells + y), pz = at(2, k * kMapCells + z);
        const std::vector<Crossing> line = crossings(mesh_, all, py, pz, kEdge);
        int winding = 0;
        auto next = line.begin();
        for (std::size_t n = 0; n < inside.size(); ++n) {
          for (; next != line.end() && next->x <= at(0, int(n)); ++next) winding += next->winding;
          inside[n] = winding > 0;
        }
        for (int i = 0; i < bricks_[0]; ++i) {
          const std::size_t b = brick_at(i, j, k), first = std::size_t(i * kMapCells);
          if (out_.brick[b] < 0) {
            out_.brick[b] = inside[first] ? map_inside : map_outside;
            continue;
          }
          const std::vector<Ball> near = near_line(b, py, pz);
          for (std::size_t n = 0; n < std::size_t(kAcross); ++n)
            set(std::size_t(out_.brick[b]) * kMapNodes + std::size_t((z * kAcross + y) * kAcross) +
                    n,
                {at(0, int(first + n)), py, pz}, inside[first + n], near);
        }
      }
  }
  /// A triangle, and a ball about it.
  struct Ball {
    Double3 center;
    double radius;
    std::int32_t triangle;
  };
  /// The triangles of a brick within the band of the line along x at (y, z).
  std::vector<Ball> near_line(std::size_t brick, double y, double z) const {
    std::vector<Ball> out;
    for (const std::int32_t t : near_[brick]) {
      const Ball& ball = ball_[std::size_t(t)];
      const double far = std::hypot(ball.center[1] - y, ball.center[2] - z);
      if (far < band_ + ball.radius) out.push_back(ball);
    }
    return out;
  }
  void set(std::size_t node, const Double3& x, bool inside, const std::vector<Ball>& near) {
    double nearest = band_;
    SharePart sum{inside ? 1.0 : 0.0, {}};
    const double scale = 1 / range_;
    for (const Ball& ball : near) {
      const double reach = ball.radius + std::max(nearest, range_);
      const Double3 way = x - ball.center;
      if (dot(way, way) >= reach * reach) continue;
      const auto t = std::size_t(ball.triangle);
      const Double3 &p = mesh_.corner(t, 0), &q = mesh_.corner(t, 1), &r = mesh_.corner(t, 2);
      const double far = distance_squared(x, p, q, r);
      nearest = std::min(nearest, std::sqrt(far));
      if (far < range_ * range_)
        sum.add(share_of_triangle(scale * x, {scale * p, scale * q, scale * r}));
    }
    const double slope = kEdge / range_;
    out_.away[node] = inside ? -nearest : nearest;
    out_.shares[node] = {slope * sum.gradient[0], slope * sum.gradient[1], slope * sum.gradient[2],
                         sum.share};
  }

  const TriangleMesh& mesh_;
  const double range_, band_;
  Double3 origin_{};
  std::array<int, 3> bricks_{};
  std::vector<Ball> ball_;                       // by triangle
  std::vector<std::vector<std::int32_t>> near_;  // triangles, by brick
  MeshMap out_;
};

}  // namespace

MeshMap make_mesh_map(const TriangleMesh& mesh, double range, double reach) {
  return Builder(mesh, range, reach).make();
}

}  // namespace pbf::program_module
