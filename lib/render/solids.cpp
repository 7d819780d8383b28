#include "lib/render/solids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "lib/render/zero_surface.h"
#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

constexpr int kAround = 64;  // corners of a circle, a multiple of 4

struct Corner {
  Double3 place, normal;  // m; out of the solid, of the smooth surface
  bool crease;            // the edge to the next corner is sharp
};
using Polygon = std::vector<Corner>;

/// Where dot(normal, x) <= level.
struct HalfSpace {
  Double3 normal;
  double level;
  double beyond(const Double3& x) const { return dot(normal, x) - level; }
};

/// A convex polygon in the plane that bounds `inside`.
struct Face {
  Polygon polygon;
  HalfSpace inside;
};

void clip(Polygon& polygon, const HalfSpace& keep) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = keep.beyond(a.place), to = keep.beyond(b.place);
    if (from <= 0) kept.push_back(a);
    if ((from <= 0) == (to <= 0)) continue;
    const double t = from / (from - to);
    // Behind the corner at which the polygon is left comes an edge along the cut.
    kept.push_back({a.place + t * (b.place - a.place), a.normal + t * (b.normal - a.normal),
                    from <= 0 || a.crease});
  }
  polygon = std::move(kept);
}

/// The side of a cuboid at the end of an axis.
Polygon rectangle(std::size_t axis, int side, const Double3& min, const Double3& max) {
  const std::size_t u = (axis + 1) % 3, w = (axis + 2) % 3;
  Double3 normal{}, place{};
  normal[axis] = side;
  place[axis] = (side < 0 ? min : max)[axis];
  Polygon polygon;
  for (const unsigned corner : {0u, 1u, 3u, 2u}) {
    place[u] = (corner & 1 ? max : min)[u], place[w] = (corner & 2 ? max : min)[w];
    polygon.push_back({place, normal, true});
  }
  return polygon;
}

/// The body in the scene's frame, put together face by face.
struct Body {
  Solid<double> solid;
  double size;  ///< m, longer than anything that is seen
  bool flat;
  bool by_distance = false;  ///< the shape has no faces of its own
  std::vector<Face> faces{};

  Double3 turned(const Double3& d) const {
    const Vec3<double> v = turned_back<3>(solid, Vec3<double>{d[0], d[1], d[2]});
    return {v.x, v.y, v.z};
  }
  Double3 placed(const Double3& p) const {
    return Double3{solid.center.x, solid.center.y, solid.center.z} + turned(p);
  }
  /// Corners and normals in the frame of the body.
  void add(Polygon polygon) { add(polygon, polygon[0].normal); }
  void add(Polygon polygon, const Double3& outward) {
    for (Corner& c : polygon) c = {placed(c.place), turned(c.normal), c.crease};
    const Double3 normal = turned(outward);
    faces.push_back({polygon, {normal, dot(normal, polygon[0].place)}});
  }

  /// Half a length along an axis; in two dimensions there are no ends along y.
  double half(std::size_t axis, double length) const {
    return flat && std::abs(solid.turn[axis][1]) > 0.5 ? size : length;
  }

  /// A ring about the body's z: radius and height, and the slope of the surface there.
  struct Ring {
    double radius, height, slope;  // angle of the normal over the x-y plane
    bool crease;
  };
  static Corner on(const Ring& r, double turn) {
    const double angle = 2 * std::numbers::pi * turn / kAround;
    const double x = std::cos(angle), y = std::sin(angle);
    return {{r.radius * x, r.radius * y, r.height},
            {std::cos(r.slope) * x, std::cos(r.slope) * y, std::sin(r.slope)},
            r.crease};
  }
  void add_bands(const std::vector<Ring>& rings) {
    for (std::size_t k = 0; k + 1 < rings.size(); ++k)
      for (int j = 0; j < kAround; ++j) {
        const Ring &low = rings[k], &high = rings[k + 1];
        Polygon polygon{on(low, j), on(low, j + 1), on(high, j + 1), on(high, j)};
        polygon[1].crease = polygon[3].crease = false;  // edges from ring to ring
        const double slope = std::atan2(low.radius - high.radius, high.height - low.height);
        add(std::move(polygon), on({0, 0, slope, false}, j + 0.5).normal);
      }
  }
  void add_tube(double radius, double half) {
    add_bands({{radius, -half, 0, true}, {radius, half, 0, true}});
    for (const double side : {-1.0, 1.0}) {
      Polygon polygon;
      for (int j = 0; j < kAround; ++j)
        polygon.push_back(on({radius, side * half, side * std::numbers::pi / 2, true}, j));
      add(std::move(polygon));
    }
  }
  void add_capsule(double radius, double half) {
    std::vector<Ring> rings;
    for (const int side : {-1, 1})
      for (int k = 0; k <= kAround / 4; ++k) {
        if (side > 0 && k == 0 && half == 0) continue;  // a sphere's equator is one ring
        const int step = side < 0 ? k - kAround / 4 : k;
        const double slope = 2 * std::numbers::pi * step / kAround;
        // At the poles exactly 0, so that no band has a hole.
        const double r = std::abs(step) == kAround / 4 ? 0 : radius * std::cos(slope);
        rings.push_back({r, side * half + radius * std::sin(slope), slope, false});
      }
    add_bands(rings);
  }
};

void add_faces(Body& body, const shape::Plane<double>&) {
  body.add(rectangle(2, 1, {-body.size, -body.size, 0}, {body.size, body.size, 0}));
}
void add_faces(Body& body, const shape::Box<double>& box) {
  const Double3 half{body.half(0, box.half.x), body.half(1, box.half.y), body.half(2, box.half.z)};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) body.add(rectangle(axis, side, -1.0 * half, half));
}
void add_faces(Body& body, const shape::Sphere<double>& s) { body.add_capsule(s.radius, 0); }
void add_faces(Body& body, const shape::Cylinder<double>& s) {
  body.add_tube(s.radius, body.half(2, s.half));
}
void add_faces(Body& body, const shape::Capsule<double>& s) {
  body.add_capsule(s.radius, body.half(2, s.half));
}
/// Of a shape without faces of its own: where its distance is 0, in the tetrahedra of a lattice.
void add_faces(Body& body, const auto& shape) {
  body.by_distance = true;
  for (const Triangle& t : zero_surface(shape)) {
    Polygon polygon;
    for (const Vec3<double>& p : t) {
      const Vec3<double> n = shape.template normal<3>(p);
      polygon.push_back({{p.x, p.y, p.z}, {n.x, n.y, n.z}, false});
    }
    const Double3 a = polygon[1].place - polygon[0].place, b = polygon[2].place - polygon[0].place;
    Double3 outward = cross(a, b);
    if (!(length(outward) > 0)) continue;
    outward = (dot(outward, polygon[0].normal) < 0 ? -1 : 1) * unit(outward);
    body.add(std::move(polygon), outward);
  }
}

void add_surface(Body& body, const std::vector<MeshTriangle>& surface) {
  body.by_distance = true;  // not convex: its cuts are not those of its faces
  for (const MeshTriangle& t : surface) {
    Polygon polygon;
    for (std::size_t k = 0; k < 3; ++k) polygon.push_back({t.place[k], t.normal[k], t.crease[k]});
    body.add(std::move(polygon), unit(cross(t.place[1] - t.place[0], t.place[2] - t.place[0])));
  }
}

/// The part of space in which a solid is drawn.
struct Bounds {
  Double3 min, max;
};
Bounds bounds_of(const View& view, const Solid<double>& solid) {
  Bounds b{view.domain_min, view.domain_max};
  const double further = length(b.max - b.min);  // as far as the picture may show
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_bounded(solid)) break;
    if (view.open[k][0]) b.min[k] -= further;
    if (view.open[k][1]) b.max[k] += further;
  }
  if (view.flat) {
    // So thin that a round body's cut is that of its middle, and no perspective is seen.
    const double plane = 0.5 * (view.domain_min[1] + view.domain_max[1]);
    b.min[1] = plane - 0.25 * view.radius, b.max[1] = plane + 0.25 * view.radius;
  }
  return b;
}

/// The part of a side of the bounds that is in a body known by its distance; faces: the whole
/// surface.
std::vector<Polygon> section_of(const Body& body, const std::vector<Face>& faces,
                                const Bounds& bounds, std::size_t axis, int side) {
  const std::size_t u = (axis + 1) % 3, w = (axis + 2) % 3;
  Double3 low = bounds.min, along_u{}, along_w{}, normal{};
  normal[axis] = side;
  low[axis] = (side < 0 ? bounds.min : bounds.max)[axis];
  const auto span = [&](std::size_t k) {  // of the body within the bounds
    double least = bounds.max[k], most = bounds.min[k];
    for (const Face& face : faces)
      for (const Corner& c : face.polygon)
        least = std::min(least, c.place[k]), most = std::max(most, c.place[k]);
    low[k] = std::max(bounds.min[k], least);
    return std::max(std::min(bounds.max[k], most) - low[k], 0.0);
  };
  along_u[u] = span(u), along_w[w] = span(w);
  const auto vec = [](const Double3& v) { return Vec3<double>{v[0], v[1], v[2]}; };
  const auto away = [&](const Vec3<double>& x) {
    return body.flat ? distance<2>(body.solid, x) : distance<3>(body.solid, x);
  };
  std::vector<Polygon> all;
  for (const auto& part : zero_section(away, vec(low), vec(along_u), vec(along_w))) {
    all.emplace_back();
    for (const auto& [x, edge] : part) all.back().push_back({{x.x, x.y, x.z}, normal, edge});
  }
  return all;
}

std::vector<Face> faces_of(const View& view, const Solid<double>& solid,
                           const std::vector<MeshTriangle>* surface) {
  const Bounds bounds = bounds_of(view, solid);
  const double size = length(view.domain_max - view.domain_min);
  const bool bounded = is_bounded(solid);
  Body body{solid, size, view.flat};
  if (view.flat) body.solid.center.y = 0.5 * (bounds.min[1] + bounds.max[1]);
  if (!bounded) {  // around the point that is nearest to the middle of the domain
    const Double3 away = 0.5 * (bounds.min + bounds.max) - body.placed({0, 0, 0}),
                  up = body.turned({0, 0, 1});
    const Double3 middle = body.placed({0, 0, 0}) + (away - dot(away, up) * up);
    body.solid.center = {middle[0], middle[1], middle[2]};
  }
  if (surface)
    add_surface(body, *surface);
  else
    solid.shape.with([&](const auto& shape) { add_faces(body, shape); });

  // Cut at the bounds: what is inside of them, and the cuts themselves.
  const std::vector<Face> whole = body.faces;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      HalfSpace keep{{}, side < 0 ? -bounds.min[axis] : bounds.max[axis]};
      keep.normal[axis] = side;
      const bool crosses = !bounded || std::ranges::any_of(whole, [&](const Face& face) {
        return std::ranges::any_of(
            face.polygon, [&](const Corner& c) { return keep.beyond(c.place) > 1e-9 * size; });
      });
      if (!crosses) continue;
      for (Face& face : body.faces) clip(face.polygon, keep);
      if (body.by_distance) {
        for (Polygon& part : section_of(body, whole, bounds, axis, side))
          body.faces.push_back({std::move(part), keep});
        continue;
      }
      Polygon cut = rectangle(axis, side, bounds.min, bounds.max);
      for (const Face& face : whole) clip(cut, face.inside);
      body.faces.push_back({std::move(cut), keep});
    }
  return std::move(body.faces);
}

}  // namespace

SolidSurfaces surfaces_of(const View& view, const Projection& projection, const Double3& sun) {
  SolidSurfaces out;
  const auto seen = [&](const Corner& c) {
    return SolidVertex{floats(projection.to_view(c.place)),
                       floats(projection.direction(unit(c.normal)))};
  };
  const auto add = [&](const Polygon& polygon, std::vector<SolidVertex>& triangles) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      for (const std::size_t k : {std::size_t{0}, i, i + 1}) triangles.push_back(seen(polygon[k]));
  };
  for (std::size_t k = 0; k < view.solids.size(); ++k) {
    const auto* surface = k < view.surfaces.size() ? view.surfaces[k].get() : nullptr;
    for (const Face& face : faces_of(view, view.solids[k], surface)) {
      const Polygon& polygon = face.polygon;
      if (polygon.size() < 3) continue;
      if (!view.flat && dot(face.inside.normal, sun) <= 0) add(polygon, out.casters);
      if (face.inside.beyond(projection.eye) <= 0) continue;
      add(polygon, out.triangles);
      for (std::size_t i = 0; i < polygon.size(); ++i)
        if (polygon[i].crease)
          out.creases.push_back({projection.to_view(polygon[i].place),
                                 projection.to_view(polygon[(i + 1) % polygon.size()].place)});
    }
  }
  return out;
}

}  // namespace pbf::render_module
