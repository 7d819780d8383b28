// A body with a surface of triangles, as a map on the nodes of a grid: its distance, and the share
// of the kernel.
#pragma once

#include <cstdint>

#include "kernels/shapes/shape.h"

namespace pbf::PBF_VARIANT {

/// Edges of a brick in cells; a brick has its nodes on all of its faces.
constexpr int kMapCells = 8, kMapAcross = kMapCells + 1,
              kMapNodes = kMapAcross * kMapAcross * kMapAcross;

/// What the map says of a brick: its number among those that are stored, or, below 0, on which side
/// of the surface it is and how many bricks at least are between it and the stored ones.
struct MapBrick {
  static constexpr int beyond(bool inside, int bricks_between) {
    return -1 - 2 * bricks_between - (inside ? 1 : 0);
  }
  static PBF_HD bool is_inside(int brick) { return ((-1 - brick) & 1) == 1; }
  static PBF_HD int bricks_between(int brick) { return (-1 - brick) / 2; }
};

namespace shape {

/// Body coordinates, h. Bricks of nodes are stored near the surface alone; elsewhere the distance
/// is `band` or more. Values between nodes: of the distance linear along each axis, of the share
/// Adini's element, cubic, which has the values and gradients of the nodes. The gradient is that of
/// the interpolant, so that no energy is gained on a closed path. Error with nodes 1/4 h apart: at
/// most 0.015 of the share and 0.07 per h of its gradient. lib/program/mesh_map.h makes maps.
template <class Real>
struct Mesh {
  static constexpr bool convex = false;
  Bounds<Real> box;                    ///< of the surface
  Vec3<Real> origin;                   ///< of the first node of brick 0
  Real edge = 1;                       ///< of a cell
  Real band = 0;                       ///< least distance in bricks that are not stored
  Real unit = 1;                       ///< of the stored distances
  int bricks[3] = {0, 0, 0};           ///< x fastest
  int stored = 0;                      ///< bricks with nodes
  const int* brick = nullptr;          ///< of each: MapBrick
  const Vec4<Real>* shares = nullptr;  ///< of each node: slopes along a cell, and the share (w)
  const Real* away = nullptr;          ///< of each node: distance from the surface

  /// With another number type the arrays are to be set anew.
  template <class To>
  PBF_HD Mesh<To> scaled(double by) const {
    Mesh<To> to;
    to.box = {pbf::scaled<To>(box.low, by), pbf::scaled<To>(box.high, by)};
    to.origin = pbf::scaled<To>(origin, by);
    to.edge = To(by * double(edge)), to.band = To(by * double(band));
    to.unit = To(by * double(unit));
    for (int k = 0; k < 3; ++k) to.bricks[k] = bricks[k];
    to.stored = stored;
    if constexpr (sizeof(To) == sizeof(Real)) to.brick = brick, to.shares = shares, to.away = away;
    return to;
  }
  PBF_HD Bounds<Real> bounds() const { return box; }
  std::int64_t nodes() const { return std::int64_t(stored) * kMapNodes; }
  std::int64_t all_bricks() const { return std::int64_t(bricks[0]) * bricks[1] * bricks[2]; }

  /// A cell: the first of its nodes, and where p is in it, 0 to 1. first < 0: of a brick that is
  /// not stored, MapBrick.
  struct Cell {
    int first;
    Real at[3];
  };
  PBF_HD Cell cell_of(Vec3<Real> p) const {
    const Real from[3] = {p.x - origin.x, p.y - origin.y, p.z - origin.z};
    Cell c{MapBrick::beyond(false, 0), {}};
    int place[3], of[3];
    for (int k = 0; k < 3; ++k) {
      const Real s = from[k] / edge;
      if (!(s >= Real(0) && s < Real(bricks[k] * kMapCells))) return c;
      const int cell = int(s);
      of[k] = cell / kMapCells, place[k] = cell % kMapCells;
      c.at[k] = s - Real(cell);
    }
    const int number = brick[(of[2] * bricks[1] + of[1]) * bricks[0] + of[0]];
    c.first = number < 0
                  ? number
                  : number * kMapNodes + (place[2] * kMapAcross + place[1]) * kMapAcross + place[0];
    return c;
  }
  /// The node of a cell at its corner k, whose bits are x, y and z.
  PBF_HD static int node(const Cell& c, int k) {
    return c.first + (k & 1) + (k >> 1 & 1) * kMapAcross + (k >> 2) * kMapAcross * kMapAcross;
  }

  template <int>
  PBF_HD Real distance(Vec3<Real> p) const {
    const Cell c = cell_of(p);
    if (c.first < 0) return far_distance(c.first, p);
    Real sum(0);
    for (int k = 0; k < 8; ++k)
      sum = sum + weight(c, 0, k & 1) * weight(c, 1, k >> 1 & 1) * weight(c, 2, k >> 2) *
                      away[node(c, k)];
    return unit * sum;
  }
  /// 0 where the surface is far.
  template <int>
  PBF_HD Vec3<Real> normal(Vec3<Real> p) const {
    const Cell c = cell_of(p);
    if (c.first < 0) return {};
    Vec3<Real> g;
    for (int k = 0; k < 8; ++k) {
      const Real x = weight(c, 0, k & 1), y = weight(c, 1, k >> 1 & 1), z = weight(c, 2, k >> 2);
      const Real s = away[node(c, k)];
      g.x = g.x + (k & 1 ? s : -s) * (y * z);
      g.y = g.y + (k & 2 ? s : -s) * (x * z);
      g.z = g.z + (k & 4 ? s : -s) * (x * y);
    }
    const Real size = square_root(dot(g, g));
    return size > Real(0) ? (Real(1) / size) * g : Vec3<Real>{};
  }

  /// Adini's element: with s the distance of p from a corner along an axis, in cells, l = 1 - s and
  /// L = l1 l2 l3, a corner's value counts L (1 + sum s (1 - 2 s)) and its slope along an axis
  /// towards p L s l. The map holds the share for one range, so that inv_range only scales the
  /// gradient.
  template <Smoothing S, bool of_density>
  PBF_HD SolidTerm<Real> share(Vec3<Real> p, Real inv_range) const {
    const Cell c = cell_of(p);
    const Real one(1);
    if (c.first < 0) return {MapBrick::is_inside(c.first) ? one : Real(0), {}};
    SolidTerm<Real> sum;
    for (int k = 0; k < 8; ++k) {
      const Vec4<Real> v = shares[node(c, k)];
      const Real slope[3] = {v.x, v.y, v.z};
      Real s[3], l[3], towards[3];
      for (int a = 0; a < 3; ++a) {
        const bool high = k >> a & 1;
        s[a] = high ? one - c.at[a] : c.at[a];
        l[a] = one - s[a];
        towards[a] = high ? Real(-1) : one;
      }
      const Real all = l[0] * l[1] * l[2];
      Real shape = one, by_slopes(0);
      for (int a = 0; a < 3; ++a) {
        shape = shape + s[a] * (one - Real(2) * s[a]);
        by_slopes = by_slopes + towards[a] * slope[a] * (s[a] * l[a]);
      }
      const Real value = v.w * shape + by_slopes;  // times `all`
      sum.share = sum.share + all * value;
      const Real beside[3] = {l[1] * l[2], l[0] * l[2], l[0] * l[1]};
      Real g[3];
      for (int a = 0; a < 3; ++a) {
        const Real d_value =
            v.w * (one - Real(4) * s[a]) + towards[a] * slope[a] * (one - Real(2) * s[a]);
        g[a] = towards[a] * (all * d_value - beside[a] * value);
      }
      sum.gradient = sum.gradient + Vec3<Real>{g[0], g[1], g[2]};
    }
    // The polynomial leaves 0 to 1 by little, where loads would not be booked.
    if (!(sum.share > Real(0))) return {};
    if (!(sum.share < one)) return {one, {}};
    // Per range, as the other shapes.
    sum.gradient = (one / (edge * inv_range)) * sum.gradient;
    return sum;
  }

 private:
  PBF_HD static Real weight(const Cell& c, int axis, bool high) {
    return high ? c.at[axis] : Real(1) - c.at[axis];
  }
  /// In a brick that is not stored; below 0 inside, and never farther than the surface is.
  PBF_HD Real far_distance(int of, Vec3<Real> p) const {
    const Real far = band + Real(MapBrick::bricks_between(of) * kMapCells) * edge;
    if (MapBrick::is_inside(of)) return -far;
    const Real x = max2(max2(box.low.x - p.x, p.x - box.high.x), Real(0)),
               y = max2(max2(box.low.y - p.y, p.y - box.high.y), Real(0)),
               z = max2(max2(box.low.z - p.z, p.z - box.high.z), Real(0));
    return max2(far, square_root(x * x + y * y + z * z));
  }
};

}  // namespace shape
}  // namespace pbf::PBF_VARIANT
