// The share of the kernel in bodies of triangles: exact integrals against closed forms and
// differences, and maps against exact integrals.
#include "lib/program/mesh_map.h"

#include <omp.h>
#include <cstring>

#include <numbers>
#include <numeric>
#include <random>

#include "kernels/boundary/solid_scene.h"
#include "lib/program/mesh_share.h"
#include "tests/support/catch.h"
#include "tests/support/meshes.h"

using namespace pbf;
using test::box_mesh;

namespace {

constexpr double kRange = 0.7, kAmplitude = 1.2065;  // of walls with h = 2 d

TriangleMesh sphere(double radius, int around, int down) {
  TriangleMesh m;
  m.vertex.push_back({0, 0, radius});
  for (int j = 1; j < down; ++j)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * j / down;
      m.vertex.push_back({radius * std::sin(b) * std::cos(a), radius * std::sin(b) * std::sin(a),
                          radius * std::cos(b)});
    }
  m.vertex.push_back({0, 0, -radius});
  const auto last = std::int32_t(m.vertex.size()) - 1;
  const auto at = [&](int i, int j) { return std::int32_t(1 + (j - 1) * around + i % around); };
  for (int i = 0; i < around; ++i) {
    m.triangle.push_back({0, at(i, 1), at(i + 1, 1)});
    m.triangle.push_back({last, at(i + 1, down - 1), at(i, down - 1)});
    for (int j = 1; j < down - 1; ++j) {
      m.triangle.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      m.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return m;
}
/// A corner piece with a concave edge.
TriangleMesh ell() {
  TriangleMesh m;
  const double outline[6][2] = {{0, 0}, {3, 0}, {3, 1.2}, {1.2, 1.2}, {1.2, 3}, {0, 3}};
  for (const double z : {0.0, 2.0})
    for (const auto& p : outline) m.vertex.push_back({p[0], p[1], z});
  for (std::int32_t i = 0; i < 6; ++i) {
    const std::int32_t j = (i + 1) % 6;
    m.triangle.push_back({i, j, j + 6});
    m.triangle.push_back({i, j + 6, i + 6});
    if (i >= 1 && i < 5) {
      m.triangle.push_back({0, j, i});
      m.triangle.push_back({6, i + 6, j + 6});
    }
  }
  return m;
}
/// At x, of the whole mesh, lengths in ranges.
SharePart exact(const TriangleMesh& m, const Double3& x, double range) {
  std::vector<std::int32_t> all(m.triangle.size());
  std::iota(all.begin(), all.end(), 0);
  SharePart sum;
  for (const Crossing& c : crossings(m, all, x[1], x[2], 0.1))
    if (c.x <= x[0]) sum.share += c.winding;
  const double s = 1 / range;
  for (std::size_t t = 0; t < m.triangle.size(); ++t)
    sum.add(share_of_triangle(s * x, {s * m.corner(t, 0), s * m.corner(t, 1), s * m.corner(t, 2)}));
  return sum;
}

}  // namespace

TEST_CASE("before a face the share of a mesh is that of a half space") {
  const TriangleMesh m = box_mesh({-5, -5, -5}, {5, 5, 0});
  for (const double z : {-0.99, -0.5, -0.01, 0.01, 0.3, 0.7, 0.99}) {
    CAPTURE(z);
    const SharePart part = exact(m, {0.13, 0.21, z}, 1);
    const auto half = half_space_share<Smoothing::consistent, false>(z);
    CHECK(part.share == Approx(half.density).margin(1e-13));
    CHECK(part.gradient[2] == Approx(half.slope).margin(1e-12));
    CHECK(part.gradient[0] == Approx(0).margin(1e-12));
  }
  CHECK(exact(m, {0, 0, 1.01}, 1).share == 0);
  CHECK(exact(m, {0.1, 0.2, -2}, 1).share == 1);
}

TEST_CASE("a sphere of many triangles has the share of a ball") {
  for (const double radius : {0.6, 1.5}) {
    const TriangleMesh m = sphere(radius, 120, 60);
    for (double c = std::max(0.013, radius - 0.9); c < radius + 0.95; c += 0.17) {
      CAPTURE(radius, c);
      const Double3 away = unit(Double3{0.3, 0.5, 0.7});
      const SharePart part = exact(m, c * away, 1);
      const auto ball = ball_share<Smoothing::consistent, false>(c, radius);
      CHECK(part.share == Approx(ball.density).margin(1e-3));  // the facets
      CHECK(dot(part.gradient, away) == Approx(ball.slope).margin(2e-3));
    }
  }
}

TEST_CASE("the gradient of a share is its derivative, and shares are between 0 and 1") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int k = 0; k < 100; ++k) {
    TriangleMesh m;
    for (int c = 0; c < 4; ++c) m.vertex.push_back({some(random), some(random), some(random)});
    m.triangle = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}};
    if (volume_of(m) < 0) std::swap(m.vertex[0], m.vertex[1]);
    const Double3 x{some(random), some(random), some(random)};
    const SharePart part = exact(m, x, 1);
    CAPTURE(k, part.share);
    CHECK(part.share > -1e-6);
    CHECK(part.share < 1 + 1e-6);
    for (std::size_t a = 0; a < 3; ++a) {
      Double3 more = x, less = x;
      more[a] += 1e-5, less[a] -= 1e-5;
      const double slope = (exact(m, more, 1).share - exact(m, less, 1).share) / 2e-5;
      CHECK(part.gradient[a] == Approx(slope).margin(2e-5));
    }
  }
}

TEST_CASE("maps of a box, a sphere, a corner and a thin plate, turned, are within their errors") {
  TriangleMesh turned_box = box_mesh({0, 0, 0}, {3, 2, 2.5}), turned_ell = ell();
  place(turned_box, {1, {1, 2, 3}, 33, {0.1, 0.2, 0.3}});
  place(turned_ell, {1, {1, 1, 0.3}, 77, {}});
  std::mt19937 random(2);
  for (const TriangleMesh& m : {box_mesh({0, 0, 0}, {3, 2, 2.5}), turned_box, sphere(1, 40, 20),
                                ell(), turned_ell, box_mesh({0, 0, 0}, {3, 3, 0.25})}) {
    require_closed(m, "mesh");
    const MeshMap made = make_mesh_map(m, {.range = kRange, .reach = 1.2});
    const shape::Mesh<double> map = made.at();
    const auto [low, high] = box_of(m);
    double worst = 0, squares = 0;
    int points = 0;
    while (points < 300) {
      Double3 x{};
      for (std::size_t a = 0; a < 3; ++a)
        x[a] = std::uniform_real_distribution<double>(low[a] - 0.8, high[a] + 0.8)(random);
      const Vec3<double> at{x[0], x[1], x[2]};
      if (const double s = map.distance<3>(at); !(s >= 0 && s <= kRange)) continue;
      ++points;
      const SharePart right = exact(m, x, kRange);
      const auto got = map.share<Smoothing::consistent, false>(at, 1 / kRange);
      worst = std::max(worst, kAmplitude * std::fabs(got.share - right.share));
      const Double3 off{got.gradient.x - right.gradient[0], got.gradient.y - right.gradient[1],
                        got.gradient.z - right.gradient[2]};
      squares += dot(off, off);
    }
    CAPTURE(m.triangle.size());
    CHECK(worst < 0.015);
    CHECK(kAmplitude / kRange * std::sqrt(squares / points) < 0.07);
  }
}

TEST_CASE("the distance of a map has the sign of the side, and is exact to a tenth of a cell") {
  const TriangleMesh m = box_mesh({0, 0, 0}, {4, 4, 4});
  const MeshMap made = make_mesh_map(m, {.range = kRange, .reach = 1.2});
  const shape::Mesh<double> map = made.at();
  for (const double z : {-1.1, -0.4, -0.01, 0.01, 0.3, 1.1}) {
    CAPTURE(z);
    CHECK(map.distance<3>({2.1, 1.9, 4 + z}) == Approx(z).margin(1e-9));
    CHECK(map.normal<3>({2.1, 1.9, 4 + z}).z == Approx(1));
  }
  CHECK(map.distance<3>({2, 2, 2}) <= -1.2);
  CHECK(map.distance<3>({2, 2, 9}) == Approx(5));
  CHECK(map.distance<3>({-50, 2, 2}) == Approx(50));
  CHECK(map.distance<3>({4.6, 4.6, 2}) == Approx(std::sqrt(0.72)).margin(0.025));
  CHECK(map.share<Smoothing::consistent, false>({2, 2, 2}, 1 / kRange).share == Approx(1));
  CHECK(map.share<Smoothing::consistent, false>({2, 2, 9}, 1 / kRange).share == 0);
}

TEST_CASE(
    "far from all parts of a mesh its distance is no larger than the true one, on all sides") {
  TriangleMesh m = box_mesh({0, 0, 0}, {1, 1, 1});
  const TriangleMesh other = box_mesh({14, 11, 9}, {15, 12, 10});
  for (const auto& t : other.triangle) m.triangle.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  m.vertex.insert(m.vertex.end(), other.vertex.begin(), other.vertex.end());
  const MeshMap made = make_mesh_map(m, {.range = kRange, .reach = 1.2});
  const shape::Mesh<double> map = made.at();
  const auto to_box = [](const Double3& x, const Double3& low) {
    double squares = 0;
    for (std::size_t a = 0; a < 3; ++a)
      squares += std::pow(std::max({low[a] - x[a], x[a] - low[a] - 1, 0.0}), 2);
    return std::sqrt(squares);
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(0, 1);
  for (int k = 0; k < 2000; ++k) {
    const Double3 x{15 * some(random), 12 * some(random), 10 * some(random)};
    const double truth = std::min(to_box(x, {0, 0, 0}), to_box(x, {14, 11, 9}));
    if (truth < 1) continue;
    CAPTURE(x[0], x[1], x[2]);
    const double found = map.distance<3>({x[0], x[1], x[2]});
    CHECK(found > 0);
    CHECK(found <= truth + 0.025);
  }
}

namespace {

/// A bottle without a neck: walls and floor of a thickness around a hollow of 2 x 2 x 2.
TriangleMesh tub(double thick) {
  TriangleMesh m;
  const double t = thick;
  const auto ring = [&](double out, double z) {
    for (const auto& [x, y] : {std::pair{0., 0.}, {2., 0.}, {2., 2.}, {0., 2.}})
      m.vertex.push_back({x == 0 ? -out : 2 + out, y == 0 ? -out : 2 + out, z});
  };
  ring(t, -t), ring(t, 2), ring(0, 2), ring(0, 0);
  for (std::int32_t r = 0; r < 3; ++r)
    for (std::int32_t k = 0; k < 4; ++k) {
      const std::int32_t a = 4 * r + k, b = 4 * r + (k + 1) % 4;
      m.triangle.insert(m.triangle.end(), {{a, b, b + 4}, {a, b + 4, a + 4}});
    }
  m.triangle.insert(m.triangle.end(), {{0, 2, 1}, {0, 3, 2}, {12, 13, 14}, {12, 14, 15}});
  return m;
}
/// A scene of one solid in a box whose walls are far.
struct OneSolid {
  MeshMap made;
  PosedSolid<double> posed;
  SolidScene<double> scene;
  explicit OneSolid(const TriangleMesh& m)
      : made(make_mesh_map(m, {.range = kRange, .reach = 1.2})) {
    posed.solid.shape = made.at();
    posed.solid.center = {20, 20, 20};
    posed.bounds = {{0, 0, 0}, {40, 40, 40}};
    scene.walls.extent = {40, 40, 40};
    scene.walls.walls = 63;
    scene.solid = &posed;
    scene.solids = 1;
  }
  OneSolid(const OneSolid&) = delete;
  Vec3<double> end(const Vec3<double>& from, const Vec3<double>& to) const {
    const Vec3<double> c = posed.solid.center;
    return solid_scene_path_end(scene, false, true, 0, c + from, c + to).x - c;
  }
  double away(const Vec3<double>& x) const { return made.at().distance<3>(x); }
};

}  // namespace

TEST_CASE("no path ends in a mesh or comes through a wall of half a smoothing length") {
  for (const TriangleMesh& m : {ell(), tub(0.5), sphere(1, 40, 20)}) {
    require_closed(m, "mesh");
    const OneSolid s(m);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto [low, high] = box_of(m);
    int met = 0;
    double deepest = 0;
    for (int i = 0; i < 40000; ++i) {
      Vec3<double> at;
      at.x = 0.5 * (low[0] + high[0] + (high[0] - low[0] + 2) * u(random));
      at.y = 0.5 * (low[1] + high[1] + (high[1] - low[1] + 2) * u(random));
      at.z = 0.5 * (low[2] + high[2] + (high[2] - low[2] + 2) * u(random));
      if (s.away(at) < 0) continue;
      const Vec3<double> to = at + 1.5 * Vec3<double>{u(random), u(random), u(random)};
      const Vec3<double> end = s.end(at, to);
      met += dot(end - to, end - to) > 0;
      deepest = std::min(deepest, s.away(end));
    }
    CAPTURE(m.triangle.size(), met);
    CHECK(met > 2000);
    CHECK(deepest > -1e-6);
  }
}

TEST_CASE("what is in a tub of walls half a smoothing length thick stays in it") {
  const OneSolid s(tub(0.5));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int walk = 0; walk < 300; ++walk) {
    Vec3<double> x{1, 1, 1};
    for (int step = 0; step < 400; ++step) {
      const Vec3<double> to = x + 0.6 * Vec3<double>{u(random), u(random), u(random)};
      if (to.z > 1.5) continue;  // the rim is round
      x = s.end(x, to);
      CAPTURE(walk, step, x.x, x.y, x.z);
      REQUIRE((x.x > -1e-6 && x.x < 2 + 1e-6 && x.y > -1e-6 && x.y < 2 + 1e-6 && x.z > -1e-6));
    }
  }
}

TEST_CASE("maps have the same bytes on any number of threads") {
  const TriangleMesh m = tub(0.5);
  omp_set_num_threads(1);
  const MeshMap one = make_mesh_map(m, {.range = kRange, .reach = 1.2});
  omp_set_num_threads(3);
  const MeshMap three = make_mesh_map(m, {.range = kRange, .reach = 1.2});
  omp_set_num_threads(omp_get_num_procs());
  CHECK(one.brick == three.brick);
  CHECK(one.away == three.away);
  REQUIRE(one.shares.size() == three.shares.size());
  CHECK(std::memcmp(one.shares.data(), three.shares.data(),
                    one.shares.size() * sizeof(one.shares[0])) == 0);
}

TEST_CASE("a map that ends at the domain is the same there, also inside of what is cut off") {
  const TriangleMesh m = box_mesh({-30, -3, -3}, {30, 3, 3});
  const MeshMap all = make_mesh_map(m, {.range = kRange, .reach = 1.2}),
                part = make_mesh_map(m, {.range = kRange,
                                         .reach = 1.2,
                                         .wanted = {{-2, -9, -9}, {2, 9, 9}},
                                         .everywhere = false});
  CHECK(part.away.size() < all.away.size() / 4);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3<double> x{2 * u(random), 5 * u(random), 5 * u(random)};
    const double near = all.at().distance<3>(x);
    CAPTURE(x.x, x.y, x.z);
    REQUIRE(part.at().distance<3>(x) == Approx(near).margin(std::fabs(near) > 1.2 ? 2 : 0.13));
    REQUIRE((part.at().distance<3>(x) < 0) == (near < 0));
    const auto share = [&](const MeshMap& of) {
      return of.at().share<Smoothing::consistent, false>(x, 1 / kRange).share;
    };
    REQUIRE(share(part) == Approx(share(all)).margin(0.013));
  }
  const auto few = [&] { make_mesh_map(m, {.range = kRange, .reach = 1.2, .most = 100000}); };
  CHECK_THROWS_WITH(few(), Catch::Contains("nodes h/4 apart near its surface"));
}

TEST_CASE("where two parts of a mesh overlap the share ends at 1") {
  TriangleMesh m = box_mesh({0, 0, 0}, {3, 3, 3});
  const TriangleMesh other = box_mesh({2, 0.3, 0.2}, {5, 2.7, 2.8});
  for (const auto& t : other.triangle) m.triangle.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  m.vertex.insert(m.vertex.end(), other.vertex.begin(), other.vertex.end());
  const MeshMap made = make_mesh_map(m, {.range = kRange, .reach = 1.2});
  const auto share = [&](const Vec3<double>& x) {
    return made.at().share<Smoothing::consistent, false>(x, 1 / kRange).share;
  };
  CHECK(share({2.5, 1.5, 1.5}) == Approx(1));
  CHECK(share({2, 1.5, 1.5}) == Approx(1).margin(1e-3));
  CHECK(made.at().distance<3>({2.5, 1.5, 1.5}) < 0);
  CHECK(share({5, 1.5, 1.5}) == Approx(0.5).margin(0.02));
  for (const Vec4<double>& v : made.shares) REQUIRE((v.w >= 0 && v.w <= 1));
}
