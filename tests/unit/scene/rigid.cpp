// Moments of meshes, and the places where they touch.
#include "lib/scene/rigid.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/meshes.h"

namespace pbf::scene_test {

TEST_CASE("the moments of a mesh are the integrals over its inside, from any place") {
  const Double3 low{1, -2, 3}, high{1.5, -1, 5}, edge{0.5, 1, 2};
  const TriangleMesh box = test::box_mesh(low, high);
  for (const Double3& from : {Double3{0, 0, 0}, {1.25, -1.5, 4}, {-7, 3, 2}}) {
    const BodyMoments m = moments_of(box, from);
    CHECK(m.volume == Approx(1));
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(m.center[i] + from[i] == Approx(0.5 * (low[i] + high[i])));
      for (std::size_t j = 0; j < 3; ++j)
        CHECK(m.second[i][j] == Approx(i == j ? edge[i] * edge[i] / 12 : 0).margin(1e-11));
    }
  }
}

TEST_CASE("the moments of a tetrahedron are those of its corners and its middle") {
  // The mean of a polynomial of degree 2 over a tetrahedron: each corner with 1/20, its middle 4/5.
  TriangleMesh t;
  t.vertex = {{0, 0, 0}, {2, 0, 0}, {0.5, 1, 0}, {0.3, 0.2, 3}};
  t.triangle = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const BodyMoments m = moments_of(t, {0.1, 0.2, 0.3});
  CHECK(m.volume == Approx(1));
  Double3 middle{};
  for (const Double3& x : t.vertex) middle = middle + 0.25 * x;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double mean = 0;  // about the middle, which adds nothing
      for (const Double3& x : t.vertex) mean += (x[i] - middle[i]) * (x[j] - middle[j]) / 20;
      CHECK(m.second[i][j] == Approx(mean));
    }
}

TEST_CASE("a mesh touches at its outermost vertices, and at others far from all these") {
  // A grid of 21 x 21 vertices on a square, with the vertex of a spike above.
  TriangleMesh mesh;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j) mesh.vertex.push_back({i * 0.1, j * 0.1, 0});
  mesh.vertex.push_back({1, 1, 2});
  const auto all = contacts_of(mesh, {1, 1, 1}, 3, 30);
  CHECK(all.size() == 30);
  const auto has = [&](const Double3& at) {
    return std::ranges::any_of(all,
                               [&](const ContactPoint& p) { return length(p.at - at) < 1e-9; });
  };
  for (const double x : {-3.0, 3.0})
    for (const double y : {-3.0, 3.0}) CHECK(has({x, y, -3}));
  CHECK(has({0, 0, 3}));
  CHECK(has({0, 0, -3}));  // farthest from all of these
  double nearest = 1e9;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, length(all[i].at - all[j].at));
  CHECK(nearest > 0.8);  // 29 places on a square of 6 by 6
  CHECK(std::ranges::all_of(all, [](const ContactPoint& p) { return p.radius == 0; }));
  CHECK(contacts_of(test::box_mesh({0, 0, 0}, {1, 1, 1}), {}, 1, 96).size() == 8);
}

}  // namespace pbf::scene_test
