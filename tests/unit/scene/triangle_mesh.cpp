// Closed surfaces, and the lattice points inside, against the solid angle of the surface.
#include "lib/scene/triangle_mesh.h"

#include <numbers>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_samples.h"

using namespace pbf;
using test::box_mesh;
using namespace pbf::scene_test;

namespace {

void add(TriangleMesh& to, const TriangleMesh& more) {
  const auto first = std::int32_t(to.vertex.size());
  to.vertex.insert(to.vertex.end(), more.vertex.begin(), more.vertex.end());
  for (const auto& t : more.triangle)
    to.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
}
/// A torus about z, with corners on the axes, through which lattice lines go.
TriangleMesh torus(double radius, double tube, int around, int across) {
  TriangleMesh m;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = radius + tube * std::cos(b);
      m.vertex.push_back({r * std::cos(a), r * std::sin(a), tube * std::sin(b)});
      const auto at = [&](int p, int q) { return std::int32_t(p % around * across + q % across); };
      m.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return m;
}
/// How often the surface winds around x: its solid angle over 4 pi (van Oosterom & Strackee 1983).
double winding(const TriangleMesh& m, const Double3& x) {
  double sum = 0;
  for (std::size_t t = 0; t < m.triangle.size(); ++t) {
    const Double3 a = m.corner(t, 0) - x, b = m.corner(t, 1) - x, c = m.corner(t, 2) - x;
    const double la = length(a), lb = length(b), lc = length(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}
/// All points of the lattice that points_in() goes through, of which the surface winds around.
std::vector<Double3> brute_force(const TriangleMesh& m, double d) {
  const auto [low, high] = box_of(m);
  std::vector<Double3> out;
  for (double k = 0.5; low[2] + k * d < high[2]; ++k)
    for (double j = 0.5; low[1] + j * d < high[1]; ++j)
      for (double i = 0.5; low[0] + i * d < high[0]; ++i) {
        const Double3 x{low[0] + i * d, low[1] + j * d, low[2] + k * d};
        if (winding(m, x) > 0.5) out.push_back(x);
      }
  return out;
}

}  // namespace

TEST_CASE("a box as a mesh has the points of a block, also where lines go through edges") {
  // Lines through the diagonals of all faces.
  const TriangleMesh m = box_mesh({-0.3, 0.1, 2}, {0.1, 0.5, 2.4});
  const std::vector<Double3> points = points_in(m, 0.05, {});
  REQUIRE(points.size() == 512);
  CHECK(points[0][0] == Approx(-0.275));
  CHECK(points[1][0] == Approx(-0.225));
  CHECK(points[511][2] == Approx(2.375));
  const std::vector<Double3> flat = points_in(m, 0.05, 0.3);
  REQUIRE(flat.size() == 64);
  for (const Double3& x : flat) CHECK(x[1] == 0.3);
  CHECK(points_in(m, 0.05, 0.6).empty());
}

TEST_CASE("the points in a mesh are those that its surface winds around") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int k = 0; k < 6; ++k) {
    TriangleMesh m = torus(1, 0.4, 12, 8);
    if (k % 2 == 1) add(m, box_mesh({0.2, -0.6, -0.3}, {1.1, 0.7, 0.2}));  // overlaps it
    if (k >= 2) place(m, {0.5 + 0.3 * k, {some(random), some(random), 1}, 37.0 * k, {1, -2, 3}});
    require_closed(m, "m");
    const double d = k < 2 ? 0.1 : 0.11;  // for k < 2 lines go through vertices
    const std::vector<Double3> points = points_in(m, d, {}), wanted = brute_force(m, d);
    CAPTURE(k, points.size(), wanted.size());
    CHECK(points == wanted);
  }
}

TEST_CASE("a mesh is scaled, then turned about the origin, then moved, and its volume follows") {
  TriangleMesh m = box_mesh({1, 0, 0}, {2, 1, 1});
  place(m, {2, {0, 0, 1}, 90, {10, 0, 0}});
  const auto [low, high] = box_of(m);
  CHECK(low == Double3{8, 2, 0});
  CHECK(high == Double3{10, 4, 2});
  CHECK(volume_of(m) == Approx(8));
}

TEST_CASE("a surface that is open, touches itself or is turned wrongly is refused with its edges") {
  const auto said = [](const TriangleMesh& m) {
    return error_of([&] { require_closed(m, "m.stl"); }).substr(2);
  };
  TriangleMesh open = box_mesh({0, 0, 0}, {1, 1, 1});
  open.triangle.pop_back();
  CHECK(said(open) ==
        "m.stl: is not closed: 3 edges have a triangle on one side only: [1, 1, 0] to [1, 0, 1], "
        "[1, 1, 0] to [1, 1, 1], [1, 0, 1] to [1, 1, 1]; close the surface, because a solid has an "
        "inside");
  TriangleMesh turned = box_mesh({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangle[0][0], turned.triangle[0][1]);
  CHECK(contains(said(turned),
                 "triangles that do not agree about the inside: the two at 3 edges turn"));
  TriangleMesh out = box_mesh({0, 0, 0}, {1, 1, 1});
  for (auto& t : out.triangle) std::swap(t[0], t[1]);
  CHECK(contains(said(out), "m.stl: is inside out"));
  TriangleMesh touching = box_mesh({0, 0, 0}, {1, 1, 1});
  add(touching, box_mesh({1, 1, 0}, {2, 2, 1}));
  for (auto& t : touching.triangle)  // one edge for both
    for (auto& v : t) v = v == 8 ? 3 : v == 12 ? 7 : v;
  CHECK(contains(said(touching),
                 "m.stl: touches itself: 1 edge belongs to more than two triangles: [1, 1, 0] to "
                 "[1, 1, 1]"));
  CHECK(said({}) == "m.stl: has no triangles");
  TriangleMesh flat = box_mesh({0, 0, 0}, {1, 1, 0});
  CHECK(contains(said(flat), "encloses no volume"));
}
