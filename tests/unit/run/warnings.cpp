// What is told of a scene before it is run.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "lib/run/emit.h"
#include "lib/run/start_neighbors.h"
#include "lib/run/warnings.h"
#include "lib/scene/load.h"
#include "tests/support/catch.h"
#include "tests/support/obstacle_shapes.h"
#include "tests/support/warning_text.h"

using namespace pbf;

namespace {

/// A pool of 12 layers in a box that it fills halfway: 768 particles.
Scene pool() {
  Scene s;
  s.domain.max = {0.4, 0.4, 1.2};
  s.fluid.spacing = 0.05;
  s.bodies.resize(1);
  s.bodies[0].max = {0.4, 0.4, 0.6};
  s.time = {0.002, 1, {}};
  return s;
}

std::vector<std::string> kinds(const Scene& s, const std::string& dir = ".") {
  std::vector<std::string> list;
  for (const Warning& w : scene_warnings({s, dir}, count_particles(s, dir))) list.push_back(w.kind);
  return list;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// All pairs of two bodies closer than half a spacing, by brute force.
std::int64_t all_close_pairs(const Scene& s) {
  const Particles p = emit_particles(s, ".");
  std::vector<std::size_t> body;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    Scene one = s;
    one.bodies = {s.bodies[b]};
    body.resize(body.size() + emit_particles(one, ".").size(), b);
  }
  std::int64_t n = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double r2 = 0;
      for (int a = 0; a < 3; ++a) r2 += std::pow(p.position[i][a] - p.position[j][a], 2);
      n += body[i] != body[j] && std::sqrt(r2) < 0.5 * s.fluid.spacing * (1 - 1e-6);
    }
  return n;
}

}  // namespace

TEST_CASE("a sound scene gives no warning") { CHECK(kinds(pool()).empty()); }

TEST_CASE("a step that leaves a pool compressed is named with the one that does not") {
  Scene s = pool();
  s.time.step = 0.04;
  const std::string text = text_of("step", s);
  CHECK(holds(text, "time.step 0.04 makes steps "));
  CHECK(holds(text, "times the longest that is safe"));
  // The remedies work: the step, the iterations that it names, and substeps.
  const double c = compression_at_rest(s, 768);
  Scene shorter = s, more = s, parts = s, taut = s;
  shorter.time.step = s.time.step * std::sqrt(kNoLiquid / c) * 0.999;
  more.solver.iterations = int(std::ceil(4 * c / kNoLiquid));
  parts.solver.substeps = int(std::ceil(std::sqrt(c / kNoLiquid)));
  taut.solver.tolerance = 0.001;
  taut.solver.max_iterations = 1000;
  for (const Scene& cured : {shorter, more, parts, taut}) CHECK(text_of("step", cured).empty());
}

TEST_CASE("no step is too long where nothing presses the fluid together") {
  Scene s = pool();
  s.time.step = 1;
  s.time.end = 10;
  Scene no_gravity = s, no_floor = s, open_side = s, open_top = s, adaptive = s;
  no_gravity.gravity = {0, 0, 0};
  no_floor.domain.open = {"z_min"};
  open_side.domain.open = {"x_max"};
  open_top.domain.open = {"z_max"};
  adaptive.time.adaptive = AdaptiveTime{};
  CHECK(text_of("step", no_gravity).empty());
  CHECK(text_of("step", no_floor).empty());
  CHECK(text_of("step", open_side).empty());
  CHECK(!text_of("step", open_top).empty());
  CHECK(holds(text_of("step", adaptive), "time.adaptive.force 0.25 makes steps 1.1 times"));
  adaptive.time.adaptive->force = 0.2;
  CHECK(text_of("step", adaptive).empty());
}

TEST_CASE("the depth that presses a fluid is along gravity, whatever its axis and sign") {
  Scene s = pool();
  const double c = compression_at_rest(s, 768);
  Scene lying = s;
  lying.gravity = {9.81, 0, 0};
  lying.domain.max = {1.2, 0.4, 0.4};
  lying.bodies[0].max = {0.6, 0.4, 0.4};
  CHECK_THAT(compression_at_rest(lying, 768), Catch::Matchers::WithinRel(c, 1e-12));
  Scene lid = s;
  lid.gravity = {0, 0, 9.81};
  CHECK_THAT(compression_at_rest(lid, 768), Catch::Matchers::WithinRel(c, 1e-12));
}

TEST_CASE("bodies that would jump through each other are named with the step that shows them") {
  Scene s = pool();
  s.domain.max = {2, 2, 2};
  s.gravity = {0, 0, 0};
  s.bodies.resize(3);
  for (int b = 0; b < 3; ++b) {
    s.bodies[b].min = {0.5 * b, 0, 0};
    s.bodies[b].max = {0.5 * b + 0.3, 0.3, 0.3};
  }
  s.bodies[1].velocity = {100, 0, 0};
  s.bodies[2].velocity = {-100, 0, 0};
  const std::string text = text_of("speed", s);
  CHECK(holds(text, "bodies[1] and bodies[2]"));
  CHECK(holds(text, "4 h in a step"));  // 200 m/s, 2 ms, h = 0.1 m
  CHECK(holds(text, "time.step 0.0002 or less"));
  for (Body& b : s.bodies) b.velocity = {100, 0, 0};  // together
  CHECK(text_of("speed", s).empty());
}

TEST_CASE("bodies that overlap are named, however their lattices lie in each other") {
  Scene s = pool();
  s.bodies.resize(2);
  s.bodies[1].min = {0, 0, 0.5};
  s.bodies[1].max = {0.4, 0.4, 0.9};
  // Two layers twice in the same place.
  const std::string text = text_of("overlap", s);
  CHECK(holds(text, "bodies[0] and bodies[1]"));
  CHECK(holds(text, "256 particles start inside another body"));
  CHECK(holds(text, "128 pairs"));
  CHECK(all_close_pairs(s) == 128);
  // In the middle of each other's cells no pair is near.
  Scene shifted = s;
  shifted.bodies[1].min = {0.025, 0.025, 0.525};
  CHECK(all_close_pairs(shifted) == 0);
  CHECK(holds(text_of("overlap", shifted), "start inside another body"));
  // A sphere in a block, and the pairs of random places.
  Scene sphere = s;
  sphere.bodies[1] = Body{};
  sphere.bodies[1].shape = Shape::sphere;
  sphere.bodies[1].center = {0.2, 0.2, 0.62};
  sphere.bodies[1].radius = 0.15;
  CHECK(!text_of("overlap", sphere).empty());
  Scene random = s;
  random.bodies[1].shape = Shape::random_box;
  random.bodies[1].count = 300;
  CHECK(find_overlap({random, "."}).pairs == all_close_pairs(random));
  CHECK(all_close_pairs(random) > 10);
}

TEST_CASE("bodies that touch, and one random box, do not overlap") {
  Scene s = pool();
  s.bodies.resize(2);
  s.bodies[1].min = {0, 0, 0.6};
  s.bodies[1].max = {0.4, 0.4, 0.9};
  CHECK(text_of("overlap", s).empty());
  s.bodies[1].min = {0.01, 0.02, 0.6};  // beside the other's lattice
  s.bodies[1].max = {0.31, 0.32, 0.9};
  CHECK(text_of("overlap", s).empty());
  Scene random = pool();
  random.bodies[0].shape = Shape::random_box;
  random.bodies[0].count = 768;
  CHECK(kinds(random).empty());
}

TEST_CASE("a file whose particles lie in the same places twice is named") {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("pbf_twice_" + std::to_string(std::random_device{}()));
  std::filesystem::create_directories(folder);
  const auto write = [&](int times) {
    std::FILE* f = std::fopen((folder / "p.csv").c_str(), "w");
    std::fputs("x,y,z\n", f);
    for (int k = 0; k < times; ++k)
      for (int i = 0; i < 64; ++i)
        std::fprintf(f, "%g,%g,%g\n", 0.025 + 0.05 * (i % 4), 0.025 + 0.05 * (i / 4 % 4),
                     0.025 + 0.05 * (i / 16));
    std::fclose(f);
  };
  Scene s = pool();
  s.bodies[0] = Body{};
  s.bodies[0].shape = Shape::file;
  s.bodies[0].path = "p.csv";
  write(1);
  CHECK(kinds(s, folder.string()).empty());
  write(2);
  CHECK(kinds(s, folder.string()) == std::vector<std::string>{"overlap"});
  std::filesystem::remove_all(folder);
}

TEST_CASE("a search for overlap ends, also where all particles are in one place", "[slow]") {
  Scene s = pool();
  for (int b = 0; b < 2; ++b) {
    if (b == 1) s.bodies.push_back(s.bodies[0]);
    s.bodies[b].shape = Shape::random_box;
    s.bodies[b].min = {0.2, 0.2, 0.2};
    s.bodies[b].max = {0.201, 0.201, 0.201};
    s.bodies[b].count = 20000;
    s.bodies[b].seed = b;
  }
  const Overlap o = find_overlap({s, "."});
  CHECK(o.more);
  CHECK(o.pairs > 10000000);
  CHECK(holds(text_of("overlap", s), "at least "));
}

TEST_CASE("a box that holds too much is named with what it has room for") {
  Scene s = pool();
  s.bodies[0].shape = Shape::random_box;
  s.bodies[0].count = 1000;
  CHECK(holds(text_of("over-dense", s),
              "1.3 times the fluid that its box has room for; give count 768"));
  Scene all = pool();
  all.domain.max = {0.4, 0.4, 0.6};
  CHECK(text_of("over-dense", all).empty());
  all.bodies.push_back(all.bodies[0]);
  CHECK(holds(text_of("over-dense", all), "2 times the fluid that the closed domain has room for"));
  all.domain.open = {"z_max"};
  CHECK(text_of("over-dense", all).empty());
  Scene flat = pool();
  flat.dimensions = 2;
  flat.domain.max[1] = 0.05;
  flat.bodies[0].max[1] = 0.05;
  flat.bodies[0].shape = Shape::random_box;
  flat.bodies[0].count = 96;
  CHECK(kinds(flat).empty());
  flat.bodies[0].count = 120;
  CHECK(kinds(flat) == std::vector<std::string>{"over-dense"});
}

TEST_CASE("intervals beyond the end of a run are named, each of them") {
  Scene s = pool();
  s.output = Output{};
  s.output->every = 1;  // as long as the run: the first and the last frame, as wished
  CHECK(kinds(s).empty());
  s.output->every = 1.5;
  CHECK(holds(text_of("output", s), "output.every 1.5 s is longer than the run"));
  s.summary_from = 1;
  CHECK(holds(text_of("output", s), "summary_from 1 s is not before the end of the run"));
  s.summary_from = 0;
  s.render = Render{};
  s.render->every = 3;
  s.measure_every = 501;
  const std::string text = text_of("output", s);
  CHECK(holds(text, "render.every 3 s"));
  CHECK(holds(text, "measure_every"));
}

TEST_CASE(
    "an obstacle that stands where no fluid will meet it is told, one that reaches or comes in "
    "is not") {
  // h is 0.1 m, the box 0.4 x 0.4 x 1.2 m.
  const auto told = [](const Obstacle& o, const std::vector<std::string>& open = {}) {
    Scene s = pool();
    s.obstacles = {o};
    s.obstacles[0].name = "far";
    s.domain.open = open;
    return text_of("obstacles", s);
  };
  Obstacle box = pbf_test::box_obstacle({0.49, 0, 0}, {2, 0.4, 0.4});
  obstacle_keys::Box& keys = pbf_test::box_of(box);
  CHECK(told(box).empty());  // within h
  keys.min[0] = 0.51;
  CHECK(told(box) ==
        "obstacles[0] (far) lies outside the domain: no fluid will meet it; move it or remove it");
  CHECK(told(box, {"x_max"}).empty());
  keys.turn_angle = 20;
  keys.turn_axis = {0, 1, 0};
  CHECK(told(box).empty());  // its corner comes within h
  keys.turn_angle = 0;
  box.motion = Motion{};
  box.motion->kind = MotionKind::velocity;
  CHECK(told(box) ==
        "obstacles[0] (far) stays outside the domain all the time: no fluid will meet it; move it "
        "or remove it");
  box.motion->velocity = {0.5, 0, 0};  // away
  CHECK_FALSE(told(box).empty());
  box.motion->velocity = {-0.02, 0, 0};
  CHECK(told(box).empty());
  CHECK(told(pbf_test::sphere_obstacle({0.2, -0.4, 0.2}, 0.31)).empty());
  CHECK_FALSE(told(pbf_test::sphere_obstacle({0.2, -0.4, 0.2}, 0.29)).empty());
  const auto plane = [](const Double3& normal) {
    return pbf_test::plane_obstacle({0, 0, -0.11}, normal);
  };
  CHECK_FALSE(told(plane({0, 0, 1})).empty());
  CHECK_FALSE(told(plane({0, 0.01, 1})).empty());  // rises to the far corner, stays below the floor
  CHECK(told(plane({0, -0.1, 1})).empty());
  const auto pipe = [](double from) {
    return pbf_test::tube_obstacle(pbf_test::ObstacleShape::capsule, {0.2, 0.2, from},
                                   {0.2, 0.2, 2.5}, 0.3);
  };
  CHECK_FALSE(told(pipe(1.7)).empty());
  CHECK(told(pipe(1.55)).empty());
}
