// The camera and the view of a scene; no OpenGL needed.
#include "lib/render/camera.h"

#include "lib/render/overlay.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

View box_view(const Double3& size, const Double3& up) {
  View view;
  view.domain_min = {3, -2, 5};
  for (std::size_t k = 0; k < 3; ++k) view.domain_max[k] = view.domain_min[k] + size[k];
  view.up = up;
  return view;
}

Double3 corner(const View& view, unsigned bits) {
  Double3 p{};
  for (unsigned k = 0; k < 3; ++k) p[k] = (bits >> k & 1 ? view.domain_max : view.domain_min)[k];
  return p;
}

}  // namespace

TEST_CASE("the default camera sees the whole box beside the colour bar at any shape", "[render]") {
  for (const Double3& size : {Double3{2, 1, 1}, Double3{1, 3, 1}, Double3{1, 1, 8},
                              Double3{100, 1, 1}, Double3{1e-6, 1e-6, 2e-6}})
    for (const Double3& up :
         {Double3{0, 0, 1}, Double3{0, 1, 0}, Double3{-1, 0, 0}, Double3{0.3, 0.2, 0.9}})
      for (double orbit : {0.0, 90.0})
        for (const std::array<int, 2>& pixels : {std::array{1280, 720}, std::array{300, 700}}) {
          View view = box_view(size, up);
          view.size = pixels;
          view.camera.orbit = orbit;
          for (double time : {0.0, 0.7, 2.6}) {
            const Projection p = projection_of(view, time);
            double x_range[2] = {1e9, -1e9}, y_range[2] = {1e9, -1e9};
            for (unsigned i = 0; i < 8; ++i) {
              const auto [x, y] = p.to_pixel(corner(view, i));
              REQUIRE(p.to_view(corner(view, i))[2] > 0);
              x_range[0] = std::min(x_range[0], x), x_range[1] = std::max(x_range[1], x);
              y_range[0] = std::min(y_range[0], y), y_range[1] = std::max(y_range[1], y);
            }
            const Margins margins = margins_of(view);
            CHECK(x_range[0] > margins.left * pixels[0] - 1);
            CHECK(x_range[1] < (1 - margins.right) * pixels[0] + 1);
            CHECK(y_range[0] > margins.top * pixels[1] - 1);
            CHECK(y_range[1] < (1 - margins.bottom) * pixels[1] + 1);
            if (orbit == 0) {  // and no smaller than it must be
              const double fill = std::max(
                  (x_range[1] - x_range[0]) / ((1 - margins.left - margins.right) * pixels[0]),
                  (y_range[1] - y_range[0]) / ((1 - margins.top - margins.bottom) * pixels[1]));
              CHECK(fill == Approx(1).margin(0.01));
            }
          }
        }
}

TEST_CASE("the default camera of a scene in two dimensions looks along y, x to the right",
          "[render]") {
  View view = box_view({1, 0.01, 2}, {0, 0, 1});  // x is not the longest side
  view.flat = true;
  const Projection p = projection_of(view, 0);
  CHECK(p.forward[1] == Approx(1));
  CHECK(p.right[0] == Approx(1));
  CHECK(p.to_pixel(corner(view, 5))[0] < 0.88 * view.size[0]);
  Scene s;
  CHECK_FALSE(view_of(s, 1).flat);
  s.dimensions = 2;
  CHECK(view_of(s, 1).flat);
}

TEST_CASE("the default camera stands above, with the longest side across, not mirrored",
          "[render]") {
  struct Case {
    Double3 size, up, across;
  };
  for (const Case& c :
       {Case{{3, 1, 1}, {0, 0, 1}, {1, 0, 0}}, Case{{1, 3, 1}, {0, 0, 1}, {0, 1, 0}},
        Case{{3, 1, 1}, {0, 1, 0}, {1, 0, 0}}, Case{{1, 1, 4}, {0, 1, 0}, {0, 0, 1}}}) {
    const View view = box_view(c.size, c.up);
    const Projection p = projection_of(view, 0);
    double above = 0, run = 0, mirror = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      above += (p.eye[k] - view.domain_max[k]) * c.up[k];
      run += p.right[k] * c.across[k];
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      mirror += (p.right[a] * p.up[b] - p.right[b] * p.up[a]) * -p.forward[k];
    }
    CHECK(above > 0);
    CHECK(run > 0.8);
    CHECK(mirror == Approx(1));
  }
}

TEST_CASE("an orbit of 90 degrees per second is a quarter turn after a second", "[render]") {
  View view = box_view({2, 2, 2}, {0, 0, 1});
  view.camera.position = Double3{14, -1, 6};
  view.camera.target = Double3{4, -1, 6};
  view.camera.orbit = 90;
  const Projection p = projection_of(view, 1);
  CHECK(p.eye[0] == Approx(4).margin(1e-9));
  CHECK(p.eye[1] == Approx(9));
  CHECK(p.eye[2] == Approx(6));
  CHECK(p.forward[1] == Approx(-1));
}

TEST_CASE("a camera may look straight down", "[render]") {
  View view = box_view({2, 2, 2}, {0, 0, 1});
  view.camera.position = Double3{4, -1, 20};
  const Projection p = projection_of(view, 0);
  CHECK(p.forward[2] == Approx(-1));
  CHECK(std::isfinite(p.right[0] + p.right[1] + p.right[2]));
}

TEST_CASE("a camera that cannot look is refused by name", "[render]") {
  View view = box_view({2, 2, 2}, {0, 0, 1});
  view.camera.fov = 0;
  auto [code, text] = error_of([&] { projection_of(view, 0); });
  CHECK(code == 2);
  CHECK(text.find("render.camera.fov") != std::string::npos);
  view = box_view({2, 2, 2}, {0, 0, 1});
  view.camera.position = Double3{4, -1, 6};  // the centre of the box
  std::tie(code, text) = error_of([&] { projection_of(view, 0); });
  CHECK(code == 2);
  CHECK(text.find("render.camera.position") != std::string::npos);
  std::tie(code, text) = error_of([] { projection_of(box_view({2, 0, 2}, {0, 0, 1}), 0); });
  CHECK(code == 2);
}

TEST_CASE("the view of a scene has what the scene says, and a range for every colouring",
          "[render]") {
  Scene scene;
  scene.domain.max = {2, 1, 0.5};
  scene.gravity = {0, 0, -8};
  scene.fluid.spacing = 0.04;
  CHECK(view_of(scene, 10).radius == 0.02);
  CHECK(view_of(scene, 10).up == Double3{0, 0, 1});

  scene.render = Render{};
  scene.render->radius = 0.3;
  scene.render->size = {64, 48};
  scene.render->color = ColorBy::density;
  CHECK(view_of(scene, 10).range == std::array{900.0, 1100.0});
  CHECK(view_of(scene, 10).radius == 0.3);
  CHECK(view_of(scene, 10).size == std::array{64, 48});
  scene.render->color = ColorBy::compression;
  CHECK(view_of(scene, 10).range == std::array{0.0, 0.01});
  scene.render->color = ColorBy::id;
  CHECK(view_of(scene, 10).range == std::array{0.0, 9.0});
  CHECK(view_of(scene, 1).range == std::array{0.0, 1.0});
  scene.render->range = {2.0, 5.0};
  CHECK(view_of(scene, 10).range == std::array{2.0, 5.0});
}

TEST_CASE("a frame lower than the box brings the default camera nearer, a given one stays",
          "[render]") {
  View view = box_view({1, 1, 8}, {0, 0, 1});
  const Projection whole = projection_of(view, 0);
  view.frame = {view.domain_min, {view.domain_max[0], view.domain_max[1], view.domain_min[2] + 1}};
  const Projection framed = projection_of(view, 0);
  const auto away = [&](const Projection& p) { return p.to_view(corner(view, 0))[2]; };
  CHECK(away(framed) < 0.5 * away(whole));
  for (const Double3& x : frame_of(view)) {
    const auto [px, py] = framed.to_pixel(x);
    CHECK(px > 0);
    CHECK(px < view.size[0]);
    CHECK(py > 0);
    CHECK(py < view.size[1]);
  }
  view.camera.position = Double3{10, -9, 8};
  const Projection given = projection_of(view, 0);
  view.frame.reset();
  CHECK(given.eye == projection_of(view, 0).eye);
  CHECK(given.forward == projection_of(view, 0).forward);
  CHECK(given.shift == projection_of(view, 0).shift);
}
