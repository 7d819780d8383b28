// Frame and colour range against runs of shipped scenes, coarser than shipped.
#include <set>

#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/render/camera.h"
#include "lib/render/quantile_range.h"
#include "lib/run/emit.h"
#include "lib/run/linked_files.h"
#include "lib/scene/load.h"
#include "lib/solver/solver.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

struct Course {
  View view;
  std::vector<Snapshot> frames;
};

Course course_of(const std::string& name, std::vector<std::string> keys) {
  Scene scene = load_scene(PBF_SOURCE_DIR "/configs/" + name + ".yaml", keys).scene;
  read_linked_files(scene, PBF_SOURCE_DIR "/configs");
  Particles particles = emit_particles(scene, ".");
  const auto count = static_cast<std::int64_t>(particles.size());
  const auto solver = make_solver(scene, make_plan(scene, count), std::move(particles));
  Course c{view_of(scene, count), {}};
  const int frames = 40;
  const auto updates = static_cast<int>(scene.time.end / scene.time.step / frames);
  for (int k = 0; k <= frames; ++k) {
    c.frames.push_back(solver->download({"velocity", "density"}, ScalarType::f32).get());
    solver->step(updates);
  }
  return c;
}

}  // namespace

TEST_CASE("shipped scenes stay in the picture, and in the range of their colours",
          "[slow][render]") {
  const std::vector<std::pair<std::string, std::vector<std::string>>> scenes{
      {"dam_break", {"fluid.spacing=0.05"}},
      {"dam_break", {"fluid.spacing=0.05", "domain.max=[1.6,0.4,9]"}},
      {"dam_break_2d",
       {"fluid.spacing=0.02", "domain.max=[1.6,0.02,1]", "bodies.0.max=[0.4,0.02,0.8]"}},
      {"double_dam_break", {"fluid.spacing=0.05", "render.color=speed"}},
      {"minimal", {"fluid.spacing=0.04", "time.end=1.5"}},
      {"sphere_drop", {"fluid.spacing=0.05", "render.range=auto"}},
      {"stirrer",
       {"fluid.spacing=0.05", "time.end=3", "render.range=auto", "render.camera.position=auto"}},
      {"tank_at_rest", {"fluid.spacing=0.03", "time.end=2"}},
      {"wave_maker",
       {"fluid.spacing=0.04", "domain.max=[6,0.04,0.8]", "bodies.0.max=[6,0.04,0.4]",
        "obstacles.0.max=[0.2,0.04,0.8]", "time.step=0.004"}}};
  for (const auto& [name, keys] : scenes) {
    INFO(name << " " << keys.back());
    const Course course = course_of(name, keys);
    const View& view = course.view;
    std::size_t beyond = 0;
    for (const Snapshot& s : course.frames) {
      const Projection p = projection_of(view, s.time);
      const auto x = s.find("position")->as<float>();
      for (std::size_t i = 0; i < s.count; ++i) {
        const auto [px, py] = p.to_pixel({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
        beyond += px < 0 || py < 0 || px > view.size[0] || py > view.size[1];
      }
    }
    CHECK(beyond == 0);
    QuantileRange values(view, 1);
    for (const Snapshot& s : course.frames) values.add(s);
    const double share = values.between(0.01, 0.99)[1] / view.range[1];
    INFO("99 % of the particles are below " << share << " of the range");
    CHECK(share > 0.4);
    CHECK(share < 1.2);
  }
}

TEST_CASE("a box full of air does not make its fluid small", "[render]") {
  const auto width = [](const char* top) {
    const Scene scene =
        load_scene(PBF_SOURCE_DIR "/configs/minimal.yaml", {std::string("domain.max=") + top})
            .scene;
    const View view = view_of(scene, 1);
    const Projection p = projection_of(view, 0);
    return p.to_pixel({1.6, 0, 0})[0] - p.to_pixel({0, 0, 0})[0];
  };
  CHECK(width("[1.6,0.4,40]") > 0.4 * width("[1.6,0.4,0.8]"));
}

TEST_CASE("the picture of a calm tank shows more than one hue", "[render]") {
  PBF_NEEDS_GL();
  Course course = course_of("tank_at_rest", {"fluid.spacing=0.03", "time.end=0.6"});
  const Image image = Renderer(course.view).draw(course.frames[30]);
  std::array<int, 36> hues{};
  int coloured = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < 3 * image.width / 4; ++x)  // without the colour bar
      if (const Rgb c = pixel(image, x, y); chroma(c) > 25)
        ++hues[static_cast<std::size_t>(hue(c) / 10) % 36], ++coloured;
  REQUIRE(coloured > 10000);
  const auto seen =
      std::count_if(hues.begin(), hues.end(), [&](int pixels) { return pixels > 0.01 * coloured; });
  CHECK(seen >= 6);
}

TEST_CASE("quantiles of a range are those of all values, straight between neighbors", "[render]") {
  View view = front_view();
  view.color = ColorBy::density;
  const auto range = [&](std::vector<double> values, double low, double high) {
    for (double& v : values) v -= 1;  // snapshot() adds it
    QuantileRange all(view, 1);
    all.add(snapshot(std::vector<Double3>(values.size()), values));
    return all.between(low, high);
  };
  CHECK(range({3, -1, 2, 5, 4}, 0, 1) == std::array{-1.0, 5.0});
  view.color = ColorBy::id;
  CHECK(range(std::vector<double>(101, 7), 0.01, 0.99) == std::array{1.0, 99.0});
  CHECK(range(std::vector<double>(11, 7), 0.25, 0.75) == std::array{2.5, 7.5});
  CHECK(range({7}, 0.01, 0.99) == std::array{0.0, 0.0});
  view.color = ColorBy::compression;
  view.rest_density = 1;
  const double nan = std::nan("");
  CHECK(range({1.2, nan, 1.1, 0.5, HUGE_VAL}, 0, 1)[1] == Approx(0.2));
  const auto [code, text] = error_of([&] { range({nan, nan}, 0, 1); });
  CHECK(code == 2);
  CHECK(text.find("--range quantile: no particle of the frames chosen has a compression") == 0);
}

TEST_CASE("a bar has the very numbers that are printed, for densities about the rest density",
          "[render]") {
  View view = front_view();
  view.color = ColorBy::density;
  view.rest_density = 998.2;
  const BarRange density = bar_range(view, {725.13999762, 1003.25});
  CHECK(density.text == "725.14,1271.26");
  CHECK(density.ends == std::array{725.14, 1271.26});
  view.color = ColorBy::compression;
  const BarRange compression = bar_range(view, {0, 1.0 / 300});
  CHECK(compression.text == "0,0.00333333333");
  CHECK(compression.ends == std::array{0.0, 0.00333333333});
  view.color = ColorBy::speed;
  CHECK(bar_range(view, {2, 2}).ends == std::array{2.0, 2.0});
}

TEST_CASE("of too many values every so-maniest is taken", "[render]") {
  View view = front_view();
  view.color = ColorBy::id;
  QuantileRange few(view, 1 << 24), many(view, (std::int64_t{1} << 24) * 5 + 1);
  CHECK(few.stride() == 1);
  CHECK(many.stride() == 6);
  many.add(snapshot(std::vector<Double3>(61), std::vector<double>(61, 0)));
  CHECK(many.between(0, 1) == std::array{0.0, 60.0});
}
