#include "lib/program/mesh_map.h"

#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lib/base/error.h"
#include "lib/program/mesh_share.h"

namespace pbf::program_module {
namespace {

constexpr double kEdge = 0.25;
/// The first node is off the corner of the box by this part of a cell, so that no node is on a face
/// along the grid, where inside and outside would be a matter of rounding.
constexpr double kOff = 0.37;
/// Of the box in which a map is; each takes 30 bytes.
constexpr double kMostBricks = 1 << 26;
/// A line may be moved by less than this (crossings()).
constexpr double kSlack = 1e-3 * kEdge;

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

class MapBuilder {
 public:
  MapBuilder(const TriangleMesh& mesh, const MapOptions& options)
      : mesh_(mesh),
        options_(options),
        range_(options.range),
        band_(std::max(options.range, options.reach) + 2 * kEdge) {
    const auto [low, high] = box_of(mesh);
    out_.map.box = {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    out_.map.edge = kEdge;
    out_.map.band = std::max(options.range, options.reach);
    const auto &from = options.wanted.low, &to = options.wanted.high;
    const Double3 least{from.x, from.y, from.z}, most{to.x, to.y, to.z};
    double bricks = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      double first = low[a], last = high[a];
      if (!options.everywhere) first = std::max(first, least[a]), last = std::min(last, most[a]);
      last = std::max(first, last);
      origin_[a] = first - band_ - kOff * kEdge;
      const double n = std::ceil((last + band_ - origin_[a]) / (kEdge * kMapCells));
      bricks *= n;
      bricks_[a] = int(std::min(n, 1e6));
      out_.map.bricks[a] = bricks_[a];
    }
    if (!(bricks < kMostBricks)) refuse(bricks);
    out_.map.origin = {origin_[0], origin_[1], origin_[2]};
  }

  MeshMap make() {
    find_near();
    out_.brick.assign(near_.size(), 0);
    std::int64_t stored = 0;
    for (std::size_t b = 0; b < near_.size(); ++b)
      out_.brick[b] = near_[b].empty() ? -1 : int(stored++);
    if (stored * kMapNodes > options_.most) refuse(double(stored));
    out_.map.stored = int(stored);
    out_.shares.resize(std::size_t(stored) * kMapNodes);
    out_.away.resize(std::size_t(stored) * kMapNodes);
    const std::vector<int> between = bricks_between();
    const int rows = bricks_[1] * bricks_[2];
    int done = 0;
#pragma omp parallel for schedule(dynamic)
    for (int row = 0; row < rows; ++row) {
      make_row(row, between);
#pragma omp critical(pbf_mesh_map)
      if (options_.progress) options_.progress(double(++done) / rows);
    }
    return std::move(out_);
  }

 private:
  double at(std::size_t axis, int node) const { return origin_[axis] + kEdge * node; }

  [[noreturn]] static void refuse(double bricks) {
    throw Error(ExitCode::bad_input,
                fmt::format("needs {:.3g} nodes h/4 apart near its surface, which is too many; "
                            "raise fluid.spacing, or cut off what no fluid comes near",
                            bricks * kMapNodes));
  }
  /// The bricks that the interval meets along an axis; first > last: none.
  std::array<int, 2> bricks_of(std::size_t axis, double low, double high) const {
    const auto brick = [&](double x) {
      return int(std::floor(
          std::clamp((x - origin_[axis]) / (kEdge * kMapCells), -1.0, double(bricks_[axis]))));
    };
    return {std::max(brick(low), 0), std::min(brick(high), bricks_[axis] - 1)};
  }
  /// The triangles within the band of each brick, and those that lines through rows may cross.
  void find_near() {
    near_.resize(std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]));
    crossing_.resize(std::size_t(bricks_[1]) * std::size_t(bricks_[2]));
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) {
      const Double3 corner[3] = {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
      const Double3 center = (1.0 / 3) * (corner[0] + corner[1] + corner[2]);
      double radius = 0;
      for (const Double3& c : corner) radius = std::max(radius, length(c - center));
      ball_.push_back({center, radius, std::int32_t(t)});
      std::array<int, 2> by[3], on[3];
      for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] = std::minmax({corner[0][a], corner[1][a], corner[2][a]});
        by[a] = bricks_of(a, low - band_, high + band_);
        on[a] = bricks_of(a, low - kSlack, high + kSlack);
      }
      for (int k = on[2][0]; k <= on[2][1]; ++k)
        for (int j = on[1][0]; j <= on[1][1]; ++j)
          crossing_[std::size_t(k * bricks_[1] + j)].push_back(std::int32_t(t));
      const double half = 0.5 * kEdge * kMapCells, round = std::sqrt(3.0) * half + band_;
      for (int k = by[2][0]; k <= by[2][1]; ++k)
        for (int j = by[1][0]; j <= by[1][1]; ++j)
          for (int i = by[0][0]; i <= by[0][1]; ++i) {
            const Double3 middle{at(0, i * kMapCells) + half, at(1, j * kMapCells) + half,
                                 at(2, k * kMapCells) + half};
            if (distance_squared(middle, corner[0], corner[1], corner[2]) < round * round)
              near_[brick_at(i, j, k)].push_back(std::int32_t(t));
          }
    }
  }
  /// How many bricks at least are between each and the nearest stored one; 0 for neighbors.
  std::vector<int> bricks_between() const {
    constexpr int kFar = 8;  // or more
    std::vector<int> out(near_.size());
    for (std::size_t b = 0; b < near_.size(); ++b) out[b] = near_[b].empty() ? kFar : -1;
    const std::size_t step[3] = {1, std::size_t(bricks_[0]),
                                 std::size_t(bricks_[0]) * std::size_t(bricks_[1])};
    // Along one axis after the other: the largest of three differences is what remains.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto bricks = std::size_t(bricks_[axis]);
      std::vector<int> line(bricks);
      for (std::size_t b = 0; b < out.size(); ++b) {
        if (b / step[axis] % line.size() != 0) continue;
        for (std::size_t k = 0; k < line.size(); ++k) line[k] = out[b + k * step[axis]];
        for (std::size_t k = 0; k < line.size(); ++k) {
          int least = line[k];
          for (std::size_t away = 1; int(away) - 1 < least && away < line.size(); ++away) {
            if (k >= away) least = std::min(least, std::max(line[k - away], int(away) - 1));
            if (k + away < line.size())
              least = std::min(least, std::max(line[k + away], int(away) - 1));
          }
          out[b + k * step[axis]] = least;
        }
      }
    }
    return out;
  }
  std::size_t brick_at(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(bricks_[1]) + std::size_t(j)) * std::size_t(bricks_[0]) +
           std::size_t(i);
  }

  /// A row of bricks along x: lines through its nodes tell what is inside.
  void make_row(int row, const std::vector<int>& between) {
    const int j = row % bricks_[1], k = row / bricks_[1];
    const std::vector<std::int32_t>& all = crossing_[std::size_t(row)];
    std::vector<int> winding(std::size_t(bricks_[0] * kMapCells + 1));
    for (int z = 0; z < kMapAcross; ++z)
      for (int y = 0; y < kMapAcross; ++y) {
        const double py = at(1, j * kMapCells + y), pz = at(2, k * kMapCells + z);
        const std::vector<Crossing> line = crossings(mesh_, all, py, pz, kEdge);
        int sum = 0;
        auto next = line.begin();
        for (std::size_t n = 0; n < winding.size(); ++n) {
          for (; next != line.end() && next->x <= at(0, int(n)); ++next) sum += next->winding;
          winding[n] = sum;
        }
        for (int i = 0; i < bricks_[0]; ++i) {
          const std::size_t b = brick_at(i, j, k), first = std::size_t(i * kMapCells);
          if (near_[b].empty()) {
            if (z == 0 && y == 0) out_.brick[b] = MapBrick::beyond(winding[first] > 0, between[b]);
            continue;
          }
          const std::vector<Ball> near = near_line(b, py, pz);
          for (std::size_t n = 0; n < std::size_t(kMapAcross); ++n)
            set(std::size_t(out_.brick[b]) * kMapNodes +
                    std::size_t((z * kMapAcross + y) * kMapAcross) + n,
                {at(0, int(first + n)), py, pz}, winding[first + n], near);
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
  void set(std::size_t node, const Double3& x, int winding, const std::vector<Ball>& near) {
    double nearest = band_;
    SharePart sum{double(winding), {}};
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
    out_.away[node] = winding > 0 ? -nearest : nearest;
    const bool whole = sum.share > 1;  // of parts that overlap
    const double slope = whole ? 0 : kEdge / range_;
    out_.shares[node] = {slope * sum.gradient[0], slope * sum.gradient[1], slope * sum.gradient[2],
                         std::clamp(sum.share, 0.0, 1.0)};
  }

  const TriangleMesh& mesh_;
  const MapOptions& options_;
  const double range_, band_;
  Double3 origin_{};
  std::array<int, 3> bricks_{};
  std::vector<Ball> ball_;                           // by triangle
  std::vector<std::vector<std::int32_t>> near_;      // triangles, by brick
  std::vector<std::vector<std::int32_t>> crossing_;  // triangles, by row of bricks along x
  MeshMap out_;
};

}  // namespace

MeshMap make_mesh_map(const TriangleMesh& mesh, const MapOptions& options) {
  return MapBuilder(mesh, options).make();
}

}  // namespace pbf::program_module
