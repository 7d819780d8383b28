// Pictures against geometry worked out by hand.
#include <limits>

#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

struct Edges {
  int x0 = 1 << 20, x1 = -1, y0 = 1 << 20, y1 = -1;  // half open
};

/// Where the picture has colour, left of the colour bar.
Edges coloured(const Image& image) {
  Edges b;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < 3 * image.width / 4; ++x)
      if (chroma(pixel(image, x, y)) > 60)
        b = {std::min(b.x0, x), std::max(b.x1, x + 1), std::min(b.y0, y), std::max(b.y1, y + 1)};
  return b;
}

/// Without the rows at the top, which tell the number of particles.
Image below_labels(Image image) {
  image.rgb.erase(image.rgb.begin(), image.rgb.begin() + 3 * 40 * image.width);
  image.height -= 40;
  return image;
}

double slope(double angle) { return std::tan(angle); }

}  // namespace

TEST_CASE("a sphere in the middle has its analytic radius within a pixel", "[render]") {
  PBF_NEEDS_GL();
  Renderer renderer(front_view());
  const Edges b = coloured(renderer.draw(snapshot({{0, 0, 0}}, {1.0})));
  const double radius = focal(200) * slope(std::asin(0.5 / 4));
  CHECK(b.x0 == Approx(100 - radius).margin(1));
  CHECK(b.x1 == Approx(100 + radius).margin(1));
  CHECK(b.y0 == Approx(100 - radius).margin(1));
  CHECK(b.y1 == Approx(100 + radius).margin(1));
}

TEST_CASE("a sphere off the axis has its perspective outline within a pixel", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.camera.fov = 90;  // f = 100 pixels; the outline is clearly an ellipse
  Renderer renderer(view);
  const Edges b = coloured(renderer.draw(snapshot({{-1.5, -2, 0.9}}, {1.0})));
  const double half_x = std::asin(0.5 / std::hypot(1.5, 2.0)), to_x = std::atan2(-1.5, 2.0);
  const double half_z = std::asin(0.5 / std::hypot(0.9, 2.0)), to_z = std::atan2(0.9, 2.0);
  CHECK(b.x0 == Approx(std::max(0.0, 100 + 100 * slope(to_x - half_x))).margin(1));
  CHECK(b.x1 == Approx(100 + 100 * slope(to_x + half_x)).margin(1));
  CHECK(b.y0 == Approx(100 - 100 * slope(to_z + half_z)).margin(1));
  CHECK(b.y1 == Approx(100 - 100 * slope(to_z - half_z)).margin(1));
}

TEST_CASE("the nearer of two spheres hides the other, whatever their order", "[render]") {
  PBF_NEEDS_GL();
  Renderer renderer(front_view());
  const Double3 near{0.1, -1, 0}, far{-0.1, 1, 0};
  const Rgb one = pixel(renderer.draw(snapshot({near, far}, {1.0, 0.3})), 103, 100);
  const Rgb two = pixel(renderer.draw(snapshot({far, near}, {0.3, 1.0})), 103, 100);
  CHECK(hue_distance(hue(one), hue(viridis(1.0))) < 4);
  CHECK(one == two);
}

TEST_CASE("spheres that cut each other meet in the plane between them", "[render]") {
  PBF_NEEDS_GL();
  Renderer renderer(front_view());
  const Image image = renderer.draw(snapshot({{-0.3, 0, 0}, {0.3, 0, 0}}, {0.4, 1.0}));
  for (int y : {90, 100, 110}) {
    CHECK(hue_distance(hue(pixel(image, 97, y)), hue(viridis(0.4))) < 8);
    CHECK(hue_distance(hue(pixel(image, 102, y)), hue(viridis(1.0))) < 8);
  }
}

TEST_CASE("a particle has the hue of viridis at its value, and magenta without one", "[render]") {
  PBF_NEEDS_GL();
  Renderer renderer(front_view());
  for (double value : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Rgb seen = pixel(renderer.draw(snapshot({{0, 0, 0}}, {value})), 100, 100);
    INFO("value " << value);
    CHECK(hue_distance(hue(seen), hue(viridis(value))) < 4);
    CHECK(chroma(seen) > 50);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Rgb seen = pixel(renderer.draw(snapshot({{0, 0, 0}}, {nan})), 100, 100);
  CHECK(hue_distance(hue(seen), hue(kNoValue)) < 4);
}

TEST_CASE("speed colours by the length of the velocity, id by the row", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.color = ColorBy::speed;
  view.range = {0, 10};
  Snapshot s = snapshot({{0, 0, 0}}, {0});
  s.fields.push_back(field<float>("velocity", "m/s", 3, {3, 0, -4}));
  const Rgb speed = pixel(Renderer(view).draw(s), 100, 100);
  CHECK(hue_distance(hue(speed), hue(viridis(0.5))) < 4);

  view.color = ColorBy::id;
  view.range = {0, 4};
  const Rgb id = pixel(
      Renderer(view).draw(snapshot({{9, 0, 0}, {9, 0, 0}, {9, 0, 0}, {0, 0, 0}}, {0, 0, 0, 0})),
      100, 100);
  CHECK(hue_distance(hue(id), hue(viridis(0.75))) < 4);
}

TEST_CASE("density is blue below rest density, red above, white between", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.color = ColorBy::density;
  view.range = {900, 1100};
  const auto seen = [&](double density) {
    return pixel(Renderer(view).draw(snapshot({{0, 0, 0}}, {density - 1})), 100, 100);
  };
  const Rgb below = seen(900), rest = seen(1000), above = seen(1100);
  CHECK(below[2] > below[0] + 60);
  CHECK(above[0] > above[2] + 60);
  CHECK(chroma(rest) < 10);
  CHECK(seen(1300) == above);
  CHECK(hue_distance(hue(seen(std::nan(""))), hue(kNoValue)) < 4);
}

TEST_CASE("compression counts from rest density on, and what is expanded has none", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.rest_density = 1000;
  view.range = {0, 0.1};
  const auto seen = [&](double density) {
    return pixel(Renderer(view).draw(snapshot({{0, 0, 0}}, {density - 1})), 100, 100);
  };
  CHECK(hue_distance(hue(seen(1050)), hue(viridis(0.5))) < 4);
  CHECK(seen(700) == seen(1000));
}

TEST_CASE("the corners and edges of the box are where perspective puts them", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.domain_min = {-1, -1, -1};
  view.domain_max = {1, 1, 1};
  view.camera.position = Double3{0, -6, 0};
  view.size = {400, 400};
  Renderer renderer(view);
  const Image image = renderer.draw(snapshot({}, {}));
  const auto dark_near = [&](double x, double y, int limit = 160) {
    int darkest = 255;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        darkest = std::min<int>(darkest, pixel(image, static_cast<int>(std::floor(x)) + i,
                                               static_cast<int>(std::floor(y)) + j)[1]);
    return darkest < limit;
  };
  for (double depth : {5.0, 7.0})
    for (double sx : {-1.0, 1.0})
      for (double sz : {-1.0, 1.0}) {
        const double f = focal(400) / depth;
        INFO("corner " << sx << " " << sz << " at depth " << depth);
        CHECK(dark_near(200 + f * sx, 200 - f * sz));
        // Along the horizontal edge; of the floor's far one the floor hides the lower half.
        CHECK(dark_near(200 + 0.5 * f * sx, 200 - f * sz, depth == 7 && sz < 0 ? 195 : 160));
        const double aside = depth == 5 ? 5 : -5;  // away from the edge along the depth
        CHECK_FALSE(dark_near(200 + (f + aside) * sx, 200 - (f + aside) * sz));
      }
}

TEST_CASE("box edges pass before the spheres behind them and behind those before", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.domain_min = {-0.2, -0.2, -0.2};
  view.domain_max = {0.2, 0.2, 0.2};
  view.radius = 0.15;
  Renderer renderer(view);
  const int edge = static_cast<int>(100 - focal(200) * 0.2 / 3.8);  // row of the upper front edge
  const auto most_grey = [&](const Image& image) {
    return std::min(chroma(pixel(image, 100, edge)), chroma(pixel(image, 100, edge - 1)));
  };
  CHECK(most_grey(renderer.draw(snapshot({{0, 0.2, 0.2}}, {1.0}))) < 90);
  CHECK(most_grey(renderer.draw(snapshot({{0, -0.6, 0.2}}, {1.0}))) > 120);
}

TEST_CASE("particles off the picture, behind the eye or not finite change nothing", "[render]") {
  PBF_NEEDS_GL();
  Renderer renderer(front_view());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const Image empty = renderer.draw(snapshot({}, {}));
  const Image image = renderer.draw(snapshot({{0, -9, 0},
                                              {40, 0, 0},
                                              {0, 0, -40},
                                              {nan, 0, 0},
                                              {0, nan, 0},
                                              {0, inf, 0},
                                              {0, 0, -inf},
                                              {0, 1e300, 0},
                                              {0, -4, 0},
                                              {0, -4.3, 0.1}},
                                             std::vector<double>(10, 1.0)));
  CHECK(empty.rgb.size() == 3u * 200 * 200);
  CHECK(below_labels(image).rgb == below_labels(empty).rgb);
}

TEST_CASE("a particle far outside the box leaves the picture of the others as it was", "[render]") {
  PBF_NEEDS_GL();
  Renderer renderer(front_view());
  const Image alone = renderer.draw(snapshot({{0, 0, 0}}, {0.5}));
  const Image both = renderer.draw(snapshot({{0, 0, 0}, {0, 1e7, 0}}, {0.5, 1.0}));
  CHECK(share_off(below_labels(alone), below_labels(both)) < 1e-3);
}

TEST_CASE("a picture a million metres from the origin is the same", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.radius = 0.2;
  std::vector<Double3> places;
  std::vector<double> values;
  for (int i = 0; i < 30; ++i) {
    places.push_back({std::sin(1.0 * i), std::cos(2.3 * i), std::sin(3.1 * i)});
    values.push_back(i / 30.0);
  }
  const Image here = Renderer(view).draw(snapshot(places, values));
  const Image single = Renderer(view).draw(snapshot<float>(places, values));
  CHECK(share_off(here, single) < 1e-3);
  const Double3 away{1e6, -2e6, 3e6};
  for (std::size_t k = 0; k < 3; ++k) {
    view.domain_min[k] += away[k], view.domain_max[k] += away[k];
    (*view.camera.position)[k] += away[k], (*view.camera.target)[k] += away[k];
    for (auto& p : places) p[k] += away[k];
  }
  CHECK(share_off(here, Renderer(view).draw(snapshot(places, values))) < 1e-3);
}
