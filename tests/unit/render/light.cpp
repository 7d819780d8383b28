// Sky, ground and the shadow of the sun, against geometry worked out by hand.
#include "lib/render/light.h"

#include <limits>

#include "lib/scene/vector3.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

/// A tank of 2 x 2 x 1 m, seen from high up so that nothing hides the floor.
View tank_view() {
  View view;
  view.domain_min = {0, 0, 0};
  view.domain_max = {2, 2, 1};
  view.radius = 0.04;
  view.color = ColorBy::compression;
  view.rest_density = 1;
  view.size = {320, 240};
  view.camera.position = Double3{1, -2.5, 5};
  view.camera.target = Double3{1, 1, 0};
  return view;
}

Snapshot ball(const Double3& center, double radius, double value = 0.6) {
  std::vector<Double3> places;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      for (int k = -8; k <= 8; ++k) {
        const Double3 off{0.05 * i, 0.05 * j, 0.05 * k};
        if (length(off) <= radius) places.push_back(center + off);
      }
  return snapshot(places, std::vector<double>(places.size(), value));
}

/// Where the ray of the sun through `from` meets the floor.
Double3 fallen(const View& view, const Double3& from) {
  const Double3 sun = light_of(view).sun;
  return from - (from[2] / sun[2]) * sun;
}

double grey(const Rgb& c) { return (c[0] + c[1] + c[2]) / 3.0; }

}  // namespace

TEST_CASE("the floor is darker where a ball of particles stands in the sun, and only there",
          "[render]") {
  PBF_NEEDS_GL();
  const View view = tank_view();
  Renderer renderer(view);
  const Image empty = renderer.draw(snapshot({}, {}));
  const Double3 center{0.9, 0.9, 0.5};
  const Image image = renderer.draw(ball(center, 0.2));
  const Double3 below = fallen(view, center);
  CHECK(grey(pixel_at(image, view, below)) < 0.85 * grey(pixel_at(empty, view, below)));
  for (const Double3& beside : {below + Double3{0.45, 0, 0}, below + Double3{0, 0.5, 0},
                                below + Double3{0, -0.5, 0}, Double3{0.3, 0.3, 0}})
    CHECK(pixel_at(image, view, beside) == pixel_at(empty, view, beside));
}

TEST_CASE("a shadow has a soft edge, which falls off in one direction", "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  view.size = {1280, 960};
  Renderer renderer(view);
  const Image empty = renderer.draw(snapshot({}, {}));
  const Double3 center{1.3, 1, 0.5};
  const Image image = renderer.draw(ball(center, 0.2));
  int between = 0;
  double last = 1;
  for (double off = 0.3; off > 0.1; off -= 0.002) {
    const Double3 place = fallen(view, center) + Double3{off, 0, 0};
    const double share = grey(pixel_at(image, view, place)) / grey(pixel_at(empty, view, place));
    CHECK(share < last + 0.02);
    between += share > 0.75 && share < 0.97;
    last = share;
  }
  CHECK(last < 0.75);
  CHECK(between >= 3);
}

TEST_CASE("an obstacle casts a shadow on the floor and on particles", "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  const Snapshot low = ball({1, 1, 0.2}, 0.15);
  const Double3 top{1, 1, 0.35}, sun = light_of(view).sun;
  const Double3 middle = top + (0.55 / sun[2]) * sun, floor = fallen(view, middle);
  const Snapshot none = snapshot({}, {});
  const double open_top = grey(pixel_at(Renderer(view).draw(low), view, top));
  const double open_floor = grey(pixel_at(Renderer(view).draw(none), view, floor));
  view.solids = {plate(middle, {0.2, 0.2, 0.01})};  // seen beside both from here
  CHECK(grey(pixel_at(Renderer(view).draw(low), view, top)) < 0.85 * open_top);
  CHECK(grey(pixel_at(Renderer(view).draw(none), view, floor)) < 0.85 * open_floor);
}

TEST_CASE("what stands in the sun alone is not in its own shadow", "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  view.solids = {plate({1, 1, 0.3}, {0.4, 0.4, 0.1})};
  const Image image = Renderer(view).draw(snapshot({}, {}));
  const double middle = grey(pixel_at(image, view, {1, 1, 0.4}));
  for (double x : {0.7, 0.85, 1.15, 1.3})
    for (double y : {0.7, 0.9, 1.1, 1.3})
      CHECK(grey(pixel_at(image, view, {x, y, 0.4})) == Approx(middle).epsilon(0.03));
}

TEST_CASE("a face towards the sky is brighter than one beside, and that than one below",
          "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  view.solids = {plate({1, 1, 0.5}, {0.4, 0.4, 0.2})};
  const auto seen_from = [&](const Double3& eye, const Double3& place) {
    view.camera.position = eye;
    view.camera.target = Double3{1, 1, 0.5};
    return grey(pixel_at(Renderer(view).draw(snapshot({}, {})), view, place));
  };
  const double top = seen_from({1, -3, 2.5}, {1, 1, 0.7});
  const double side = seen_from({1, -3, 0.5}, {1, 0.6, 0.5});
  const double below = seen_from({1, -3, -1.5}, {1, 1, 0.3});
  CHECK(top > 1.1 * side);
  CHECK(side > 1.1 * below);
}

TEST_CASE("the sky is against gravity, whichever way that is", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  for (const double sign : {1.0, -1.0}) {
    view.up = {0, 0, sign};
    const Image image = Renderer(view).draw(snapshot({{0, 0, 0}}, {0.5}));
    CHECK(grey(pixel(image, 100, 75)) > 1.15 * grey(pixel(image, 100, 125)));
  }
  view.up = {1, 0, 0};
  const Light light = light_of(view);
  CHECK(light.sky == Double3{1, 0, 0});
  CHECK(light.sun[0] > 0.5);
}

TEST_CASE("particles that the camera does not see cast their shadow into the picture", "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  const Double3 center{1.3, 1, 0.7};
  const Double3 below = fallen(view, center);
  // The camera keeps its side, and so the sun, but comes near the floor.
  view.camera.target = below;
  view.camera.position = below + Double3{0, -0.35, 0.5};
  view.camera.fov = 20;
  REQUIRE(light_of(view).sun == light_of(tank_view()).sun);
  Renderer renderer(view);
  const Image empty = renderer.draw(snapshot({}, {})), image = renderer.draw(ball(center, 0.2));
  CHECK(grey(pixel_at(image, view, below)) < 0.85 * grey(pixel_at(empty, view, below)));
  for (int x = 0; x < 200; x += 20) CHECK(chroma(pixel(image, x, 30)) < 40);  // no particle in it
}

TEST_CASE("the sun stands still while the camera goes round", "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  view.camera.orbit = 90;
  Renderer renderer(view);
  const Double3 center{1.3, 1, 0.5};
  const Double3 below = fallen(view, center);
  for (const double time : {0.0, 0.5, 1.0}) {
    Snapshot none = snapshot({}, {}), some = ball(center, 0.2);
    none.time = some.time = time;
    CHECK(grey(pixel_at(renderer.draw(some), view, below, time)) <
          0.85 * grey(pixel_at(renderer.draw(none), view, below, time)));
  }
}

TEST_CASE("in two dimensions nothing is in shadow", "[render]") {
  PBF_NEEDS_GL();
  View view = tank_view();
  view.flat = true;
  view.domain_max = {2, 0.08, 1};
  view.camera = {};
  const Double3 low{0.8, 0.04, 0.3};
  std::vector<Double3> places{low};
  const Image alone = Renderer(view).draw(snapshot(places, {0.6}));
  for (int i = 0; i < 12; ++i) places.push_back({0.4 + 0.06 * i, 0.04, 0.6});
  const Image both = Renderer(view).draw(snapshot(places, std::vector<double>(13, 0.6)));
  CHECK(pixel_at(alone, view, low) == pixel_at(both, view, low));
  CHECK(chroma(pixel_at(alone, view, low)) > 60);
}

TEST_CASE("particles that are not finite or far outside cast no shadow", "[render]") {
  PBF_NEEDS_GL();
  const View view = tank_view();
  Renderer renderer(view);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const Image empty = renderer.draw(snapshot({}, {}));
  const Image image = renderer.draw(snapshot(
      {{nan, 1, 1}, {1, 1, inf}, {1e200, 0, 0}, {1e30, 1e30, 1e30}, {0, 0, 1e7}, {-1e7, 5, 3}},
      std::vector<double>(6, 1.0)));
  CHECK(below_texts(image) == below_texts(empty));
}
