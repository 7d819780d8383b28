// The share of the kernel in bodies of triangles: exact integrals against closed forms and
// differences, and maps against exact integrals.
#include "lib/program/mesh_map.h"

#include <numbers>
#include <numeric>
#include <random>

#include "lib/program/mesh_share.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

constexpr double kRange = 0.7, kAmplitude = 1.2065;  // of walls with h = 2 d

TriangleMesh box(const Double3& low, const Double3& high) {
  TriangleMesh m;
  for (int k = 0; k < 8; ++k)
    m.vertex.push_back(
        {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]});
  m.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}
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
  const TriangleMesh m = box({-5, -5, -5}, {5, 5, 0});
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
  TriangleMesh turned_box = box({0, 0, 0}, {3, 2, 2.5}), turned_ell = ell();
  place(turned_box, {1, {1, 2, 3}, 33, {0.1, 0.2, 0.3}});
  place(turned_ell, {1, {1, 1, 0.3}, 77, {}});
  std::mt19937 random(2);
  for (const TriangleMesh& m : {box({0, 0, 0}, {3, 2, 2.5}), turned_box, sphere(1, 40, 20), ell(),
                                turned_ell, box({0, 0, 0}, {3, 3, 0.25})}) {
    require_closed(m, "mesh");
    const MeshMap made = make_mesh_map(m, kRange, 1.2);
    const shape::Map<double> map = made.at();
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
  const TriangleMesh m = box({0, 0, 0}, {4, 4, 4});
  const MeshMap made = make_mesh_map(m, kRange, 1.2);
  const shape::Map<double> map = made.at();
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
