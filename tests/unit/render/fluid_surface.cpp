// The fluid as one surface.
#include <limits>

#include "lib/render/camera.h"
#include "lib/scene/vector3.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

constexpr double kSpacing = 0.05;

View pool_view(RenderStyle style = RenderStyle::surface) {
  View view;
  view.domain_min = {0, 0, 0};
  view.domain_max = {2, 2, 1};
  view.radius = 0.5 * kSpacing;
  view.style = style;
  view.color = ColorBy::compression;
  view.rest_density = 1;
  view.size = {640, 480};
  return view;
}

/// Layers of a lattice at rest on the floor; the value of each particle from its place.
template <class F>
Snapshot lattice(int layers, F value) {
  std::vector<Double3> places;
  std::vector<double> values;
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < 40; ++i)
      for (int j = 0; j < 40; ++j) {
        places.push_back({(i + 0.5) * kSpacing, (j + 0.5) * kSpacing, (k + 0.5) * kSpacing});
        values.push_back(value(places.back()));
      }
  return snapshot(places, values);
}
Snapshot pool(int layers) {
  return lattice(layers, [](const Double3&) { return 0.5; });
}

/// Largest difference of green around its mean over the middle of a pool `height` deep.
double unevenness(const Image& image, const View& view, double height) {
  double low = 255, high = 0, sum = 0;
  int n = 0;
  for (double x = 0.5; x < 1.5; x += 0.013)
    for (double y = 0.5; y < 1.5; y += 0.013, ++n) {
      const double green = pixel_at(image, view, {x, y, height})[1];
      low = std::min(low, green), high = std::max(high, green), sum += green;
    }
  return (high - low) / (sum / n);
}

}  // namespace

TEST_CASE("a pool at rest is one even surface, where spheres are a pattern", "[slow][render]") {
  PBF_NEEDS_GL();
  const Snapshot s = pool(4);
  const double height = 4 * kSpacing;
  for (const double elevation : {20.0, 45.0, 80.0}) {
    INFO("elevation " << elevation);
    const double angle = elevation * std::numbers::pi / 180;
    View view = pool_view();
    view.domain_max[2] = 3;  // no line of the box before the surface
    view.camera.target = Double3{1, 1, height};
    view.camera.position = Double3{1, 1 - 4 * std::cos(angle), height + 4 * std::sin(angle)};
    const Image smooth = Renderer(view).draw(s);
    view.style = RenderStyle::spheres;
    const Image spheres = Renderer(view).draw(s);
    CHECK(unevenness(smooth, view, height) < 0.10);
    CHECK(unevenness(spheres, view, height) > 0.25);
  }
}

TEST_CASE("the surface has no holes between the particles of one layer at rest", "[slow][render]") {
  PBF_NEEDS_GL();
  View view = pool_view();
  view.camera.target = Double3{1, 1, 0};
  view.camera.position = Double3{1, 0.999, 4};
  const auto least_chroma = [&](const Image& image) {
    int least = 255;
    for (double x = 0.3; x < 1.7; x += 0.005)
      for (double y = 0.3; y < 1.7; y += 0.005)
        least = std::min(least, chroma(pixel_at(image, view, {x, y, 0.5 * kSpacing})));
    return least;
  };
  // Through a hole the floor is seen, which has no colour; one layer of water is a pale green.
  const int surface = least_chroma(Renderer(view).draw(pool(1)));
  view.style = RenderStyle::spheres;
  const int spheres = least_chroma(Renderer(view).draw(pool(1)));
  CHECK(surface > 35);
  CHECK(spheres < 25);
}

TEST_CASE(
    "the surface has the hue of the colour bar at the value around, and goes from one to "
    "the other",
    "[render]") {
  PBF_NEEDS_GL();
  View view = pool_view();
  view.camera.target = Double3{1, 1, 0.3};
  view.camera.position = Double3{1, -1.2, 3};
  const Snapshot s = lattice(8, [](const Double3& p) { return p[0] < 1 ? 0.3 : 0.8; });
  const Image image = Renderer(view).draw(s);
  const auto off = [&](double x, double value) {
    return hue_distance(hue(pixel_at(image, view, {x, 1, 0.4})), hue(viridis(value)));
  };
  CHECK(off(0.4, 0.3) < 6);
  CHECK(off(1.6, 0.8) < 6);
  int between = 0;
  for (double x = 0.85; x < 1.15; x += 0.01) between += off(x, 0.3) > 10 && off(x, 0.8) > 10;
  CHECK(between >= 4);
}

TEST_CASE("an obstacle before the surface hides it, and one behind is hidden", "[slow][render]") {
  PBF_NEEDS_GL();
  View view = pool_view();
  view.camera.target = Double3{1, 1, 0.3};
  view.camera.position = Double3{1, 0.5, 4};
  const Snapshot s = pool(10);  // 0.5 m deep
  const auto seen = [&](double z) {
    view.solids = {plate({1, 1, z}, {0.3, 0.3, 0.02})};
    return pixel_at(Renderer(view).draw(s), view, {1, 1, z});
  };
  const int open = chroma([&] {
    view.solids = {};
    return pixel_at(Renderer(view).draw(s), view, {1, 1, 0.5});
  }());
  CHECK(open > 60);
  CHECK(chroma(seen(0.7)) < 45);
  CHECK(chroma(seen(0.1)) > 0.8 * open);
}

TEST_CASE("an empty frame is the same picture in both styles", "[render]") {
  PBF_NEEDS_GL();
  const Image surface = Renderer(pool_view()).draw(snapshot({}, {}));
  CHECK(surface.rgb == Renderer(pool_view(RenderStyle::spheres)).draw(snapshot({}, {})).rgb);
}

TEST_CASE("one particle is a drop of its colour where it is", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.style = RenderStyle::surface;
  view.radius = 0.3;
  const Image empty = Renderer(view).draw(snapshot({}, {}));
  const Image image = Renderer(view).draw(snapshot({{0, 0, 0}}, {0.9}));
  const double radius = focal(200) * std::tan(std::asin(1.6 * 0.3 / 4));
  int changed = 0;
  for (int y = kBelowTexts; y < 200; ++y)
    for (int x = 0; x < 150; ++x) {
      const bool differs = pixel(image, x, y) != pixel(empty, x, y);
      changed += differs;
      if (differs) CHECK(std::hypot(x + 0.5 - 100, y + 0.5 - 100) < radius + 1.5);
    }
  const double sphere = std::numbers::pi * radius * radius;
  CHECK(changed > 0.4 * sphere);  // a little less than its share of the fluid, a ball of 0.6
  CHECK(changed < 0.7 * sphere);
  CHECK(hue_distance(hue(pixel(image, 100, 100)), hue(viridis(0.9))) < 15);
}

TEST_CASE("a row of particles has a smooth outline, without the bumps of single ones", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.style = RenderStyle::surface;
  view.radius = 0.12;  // 19 pixels from one particle to the next
  std::vector<Double3> places;
  for (int i = -8; i <= 8; ++i) places.push_back({0.24 * i, 0, 0});
  const Image empty = Renderer(view).draw(snapshot({}, {}));
  const Image image =
      Renderer(view).draw(snapshot(places, std::vector<double>(places.size(), 0.5)));
  int thinnest = 200, thickest = 0;  // pixels
  for (int x = 40; x < 140; ++x) {
    int thick = 0;
    for (int y = kBelowTexts; y < 170; ++y)
      thick += std::abs(chroma(pixel(image, x, y)) - chroma(pixel(empty, x, y))) > 20;
    thinnest = std::min(thinnest, thick), thickest = std::max(thickest, thick);
  }
  CHECK(thinnest > 15);
  INFO("from " << thinnest << " to " << thickest << " pixels");
  CHECK(thickest - thinnest <= 4);
}

TEST_CASE("a particle without a value is magenta, one without a place is left out", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.style = RenderStyle::surface;
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  Renderer renderer(view);
  const Rgb seen = pixel(renderer.draw(snapshot({{0, 0, 0}}, {nan})), 100, 100);
  CHECK(hue_distance(hue(seen), hue(kNoValue)) < 8);
  const Image alone = renderer.draw(snapshot({{0, 0, 0}}, {0.5}));
  const Image more = renderer.draw(snapshot(
      {{nan, 0, 0}, {0, 0, 0}, {0, inf, 0}, {0, -4, 0}, {0, -9, 0}}, std::vector<double>(5, 0.5)));
  CHECK(below_texts(alone) == below_texts(more));
  // Beside one that has a value it changes nothing but its own place.
  const Image pair = renderer.draw(snapshot({{-0.9, 0, 0}, {0.9, 0, 0}}, {0.3, nan}));
  CHECK(hue_distance(hue(pixel(pair, 29, 100)), hue(viridis(0.3))) < 15);
}

TEST_CASE("in two dimensions the surface is a plane in the colour of the value", "[render]") {
  PBF_NEEDS_GL();
  View view = pool_view();
  view.flat = true;
  view.domain_max = {2, kSpacing, 1};
  std::vector<Double3> places;
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 10; ++k)
      places.push_back({(i + 0.5) * kSpacing, 0.5 * kSpacing, (k + 0.5) * kSpacing});
  const Image image =
      Renderer(view).draw(snapshot(places, std::vector<double>(places.size(), 0.6)));
  int low = 255, high = 0;
  for (double x = 0.2; x < 1.8; x += 0.01)
    for (double z = 0.1; z < 0.4; z += 0.01) {
      const Rgb c = pixel_at(image, view, {x, 0, z});
      CHECK(hue_distance(hue(c), hue(viridis(0.6))) < 4);
      low = std::min<int>(low, c[1]), high = std::max<int>(high, c[1]);
    }
  CHECK(high - low < 0.05 * high);
}

TEST_CASE("the surface is the same from picture to picture and for any number of threads",
          "[slow][render]") {
  PBF_NEEDS_GL();
  const View view = pool_view();
  const Snapshot s = lattice(3, [](const Double3& p) { return 0.5 * p[0]; });
  Renderer renderer(view);
  const Image first = renderer.draw(s);
  renderer.draw(pool(6));
  CHECK(renderer.draw(s).rgb == first.rgb);
  CHECK(Renderer(view, 1).draw(s).rgb == first.rgb);
}
