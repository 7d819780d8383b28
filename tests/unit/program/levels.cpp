// Whether a scene has levels, and what the plan says of them.
#include "lib/program/levels.h"

#include <algorithm>

#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

Scene tank(const std::string& levels, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"solver.levels=" + levels};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene_test::parse(
      "domain: {min: [0, 0, 0], max: [0.4, 0.4, 1.9]}\n"
      "fluid: {spacing: 0.02}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 1.28]}]\n"  // 64 layers
      "time: {step: 0.002, end: 1}\n",
      overrides);
}
Plan plan_of(const Scene& s) { return make_plan(s, 1000); }

std::string why_without(const Plan& plan) {
  for (const LeftOut& l : plan.left_out)
    if (l.what.rfind("levels", 0) == 0) return l.because;
  return "there";
}

std::int64_t bytes_of(const Plan& plan, const std::string& name) {
  for (const PlanArray& a : plan.memory.arrays)
    if (a.name == name) return a.bytes;
  return -1;
}

bool has_stage(const Plan& plan) {
  const auto passes = count_passes(plan.program);
  return std::any_of(passes.begin(), passes.end(),
                     [](const PassCount& c) { return std::string(c.pass->stage) == "levels"; });
}

}  // namespace

TEST_CASE("without levels the plan has no pass, no array and says why") {
  for (const Scene& s :
       {tank("off"), tank("auto", {"fluid.spacing=0.04"}), tank("on", {"solver.iterations=0"})}) {
    const Plan plan = plan_of(s);
    CHECK_FALSE(has_stage(plan));
    CHECK(plan.levels.all.count == 0);
    for (const char* array : {"level home", "level cell sum", "level multiplier"})
      CHECK(bytes_of(plan, array) == -1);
    CHECK(plan_text(plan, s).find("\n  levels: grids coarser than h: ") != std::string::npos);
  }
  CHECK(why_without(plan_of(tank("off"))) == "solver.levels is off");
  CHECK(why_without(plan_of(tank("auto", {"fluid.spacing=0.04"}))) ==
        "solver.levels is auto, the fluid less than 64 layers deep");
  CHECK(why_without(plan_of(tank("on", {"solver.iterations=0"}))) == "solver.iterations is 0");
}

TEST_CASE(
    "with levels the plan counts the bytes of the cells of 2 h, of all nodes and of each "
    "particle's cell") {
  const Scene s = tank("on");  // a box of 5 x 5 x 23.75 cells
  const Plan plan = plan_of(s);
  CHECK(has_stage(plan));
  CHECK(why_without(plan) == "there");
  // Intervals 5 5 24; 3 3 12; 2 2 6; 1 1 3: hats of 16 cells, as high as the fluid.
  const int nodes = 6 * 6 * 25 + 4 * 4 * 13 + 3 * 3 * 7 + 2 * 2 * 4;
  CHECK(plan.levels.nodes() == nodes);
  const std::int64_t cells = 5 * 5 * 24, particles = 1000;
  CHECK(bytes_of(plan, "level home") == particles * 4);
  CHECK(bytes_of(plan, "level cell count") == cells * 4);
  CHECK(bytes_of(plan, "level cell sum") == cells * 8);
  CHECK(bytes_of(plan, "level move") == cells * 16);
  const std::int64_t bricks = 2 * 2 * 6, runs = 11 * 49 * 6;
  CHECK(bytes_of(plan, "level corner sum") == bricks * 64);
  CHECK(bytes_of(plan, "level run start") == runs * 4);
  CHECK(bytes_of(plan, "level reach") == nodes * 4);
  CHECK(bytes_of(plan, "level answer") == nodes * 4);
  CHECK(bytes_of(plan, "level multiplier") == nodes * 4);
  CHECK(bytes_of(plan, "level factor") == cells * 16);
  CHECK(bytes_of(plan, "level walls") == nodes * 4);
  CHECK(bytes_of(plan_of(tank("on", {"precision=double"})), "level multiplier") == nodes * 8);
  CHECK(plan.bytes() - plan_of(tank("off")).bytes() ==
        particles * 4 + cells * 44 + nodes * 16 + bricks * 64 + runs * 4);
  const std::string text = plan_text(plan, s);
  CHECK(text.find("  level cells ") != std::string::npos);
  CHECK(text.find("  level multipliers ") != std::string::npos);
  CHECK(text.find("levels: grids coarser") == std::string::npos);
}

TEST_CASE("levels auto: on from 64 layers of fluid along gravity on, of all bodies together") {
  CHECK(has_levels(tank("auto")));
  CHECK_FALSE(has_levels(tank("auto", {"fluid.spacing=0.0201"})));
  CHECK(has_levels(tank("auto", {"obstacles=[{name: a, shape: sphere, center: [0.2, 0.2, 0.2], "
                                 "radius: 0.1}]"})));
  CHECK_FALSE(has_levels(tank("auto", {"gravity=[9.81, 0, 0]"})));
  CHECK_FALSE(has_levels(tank("auto", {"gravity=[0, 0, 0]"})));
  CHECK(has_levels(tank("auto", {"gravity=[1, 0, -9.81]"})));
  CHECK(has_levels(tank("on", {"fluid.spacing=0.1"})));
  CHECK_FALSE(has_levels(tank("off", {"fluid.spacing=0.005"})));
  const auto bodies = [](const std::string& text) {
    return has_levels(tank("auto", {"bodies=[" + text + "]"}));
  };
  const std::string pool = "{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.64]}";
  CHECK_FALSE(bodies(pool));
  CHECK(bodies(pool + ", {shape: sphere, center: [0.2, 0.2, 1.2], radius: 0.1}"));
  CHECK_FALSE(bodies(pool + ", {shape: sphere, center: [0.2, 0.2, 1.1], radius: 0.1}"));
  CHECK_FALSE(bodies("{shape: file, path: deep.csv}"));  // not known before it is read
}

TEST_CASE("levels go on as long as they fit twice into the depth of the fluid") {
  const auto levels = [](const Scene& s, const BodyBox& of_files = kNoBox) {
    StartNeighbors start;
    start.of_files = of_files;
    return make_plan(s, 8000000, start).levels.all.count;
  };
  // A cell is four layers high: level l fits twice into 4 * 2^(l + 1) layers.
  const auto block = [](double layers) {
    return scene_test::parse(
        "domain: {min: [0, 0, 0], max: [4, 4, 4]}\n"
        "fluid: {spacing: 0.02}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [4, 4, " +
            std::to_string(layers * 0.02) + "]}]\n" + "time: {step: 0.002, end: 1}\n",
        {"solver.levels=on"});
  };
  CHECK(levels(block(6)) == 1);
  CHECK(levels(block(15)) == 1);
  CHECK(levels(block(17)) == 2);
  CHECK(levels(block(31)) == 2);
  CHECK(levels(block(33)) == 3);
  CHECK(levels(block(190)) == 5);
  Scene weightless = block(6);
  weightless.gravity = {0, 0, 0};
  CHECK(levels(weightless) > 5);  // without gravity there is no depth
  // Particles of files count with the bodies.
  CHECK(levels(block(6), {{0, 0, 0}, {4, 4, 34 * 0.02}}) == 3);
  CHECK(levels(block(6), {{0, 0, 2}, {4, 4, 2.01}}) == 4);
}
