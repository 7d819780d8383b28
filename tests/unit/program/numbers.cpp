// What the plan says of dimensionless numbers and of waves.
#include "lib/program/numbers.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "lib/program/wave_plan.h"
#include "tests/support/catch.h"
#include "tests/support/flume.h"

namespace pbf::scene_test {
namespace {

/// Fails if there is no such number.
SceneNumber number_of(const Scene& s, const std::string& name) {
  for (const SceneNumber& n : scene_numbers(s))
    if (n.name == name) return n;
  FAIL("no number " + name);
  return {};
}
bool has_number(const Scene& s, const std::string& name) {
  return contains(numbers_part(s), "\n  " + name + " ");
}

}  // namespace

TEST_CASE("numbers: fluid falls from where it hangs to the level that obstacles leave it") {
  const std::vector<std::string> tank{"fluid.spacing=0.02", "domain.max=[2,1,1]"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), tank.begin(), tank.end());
    return shipped("minimal", more);
  };
  // U^2 = g fall, c^2 = g D. Half of the floor, 0.4 m high: 0.2 m at rest.
  const Scene hangs = with({"bodies.0.min=[0,0,0.5]", "bodies.0.max=[1,1,0.9]"});
  CHECK(number_of(hangs, "Fr").value == Approx(std::sqrt((0.9 - 0.2) / 0.4)).epsilon(0.01));
  // 0.5 m high: 0.25 m at rest; with a step of 0.1 m in the other half 0.3 m.
  const Scene stands = with({"bodies.0.min=[0,0,0]", "bodies.0.max=[1,1,0.5]"});
  CHECK(number_of(stands, "Fr").value == Approx(std::sqrt(0.25 / 0.5)).epsilon(0.01));
  Scene step = stands;
  Obstacle box;
  box.shape = obstacle_keys::Box{.min = {1, 0, 0}, .max = {2, 1, 0.1}};
  step.obstacles.push_back(box);
  CHECK(number_of(step, "Fr").value == Approx(std::sqrt(0.2 / 0.5)).epsilon(0.01));
}

TEST_CASE("numbers: a dam break has the Reynolds number that the spacing allows, and no waves") {
  const Scene s = shipped("dam_break_over_box", {"fluid.spacing=0.0125"});
  CHECK(number_of(s, "D/d").value == Approx(44));
  CHECK(number_of(s, "Re").value == Approx(220));
  CHECK(number_of(s, "Re").note == "numerical, at most 5 D/d = 220");
  // It falls from 0.55 m to the level at rest, 0.55 * 1.228/3.22 m.
  CHECK(number_of(s, "Fr").value == Approx(std::sqrt(1 - 1.228 / 3.22)).epsilon(0.01));
  CHECK_FALSE(has_number(s, "H/d"));
  // Real viscosity lowers it.
  const Scene oil =
      shipped("dam_break_over_box", {"fluid.spacing=0.0125", "viscosity.kinematic=0.01"});
  CHECK(number_of(oil, "Re").value < 150);
}

TEST_CASE("numbers: a tank of 2 cm has the note on surface tension, one of 0.5 m has not") {
  const Scene low = parse(kMinimal, {"bodies.0.max=[1, 1, 0.02]", "fluid.spacing=0.002"});
  CHECK(contains(number_of(low, "Bo").note, "surface tension matters in water of this size"));
  CHECK(number_of(low, "Bo").value == Approx(1000 * 9.81 * 0.02 * 0.02 / 0.072));
  CHECK(number_of(parse(kMinimal), "Bo").note.empty());
  CHECK_FALSE(has_number(low, "Re"));  // it rests
}

TEST_CASE("plan: a wave maker has length, stroke, limits, resolution, loss and return") {
  const Scene s = flume(kRegular);
  const std::string text = wave_part(s);
  CAPTURE(text);
  for (const char* part :
       {"waves paddle: regular, piston, second order: H 0.06 m, T 2 s, depth 0.3 m\n",
        "  length 3.258 m, kD 0.579, speed 1.63 m/s, group 1.47 m/s; breaks at 0.234 m (McCowan); "
        "Ursell 23.6, second order holds below 26.3\n",
        "  stroke 0.104 m, second harmonic 0.0089 m; with order 1 a free wave of 0.19 of the first "
        "harmonic would run along\n",
        "  6 particles per height, 326 per wavelength, 30 per depth; 500 steps per period\n",
        "expected loss of height: about 2.7 % per wavelength (estimate, fitted to flumes in two "
        "dimensions with levels: on and h = 2 d)",
        "  the first wave is at the far end at 5.3 s, and back at 10.6 s\n"})
    CHECK(contains(text, part));
  const Json json = wave_json(s);
  REQUIRE(json.size() == 1);
  CHECK(json[0]["name"] == "paddle");
  CHECK(json[0]["loss_per_length"].get<double>() == Approx(0.027).margin(5e-4));
  CHECK(number_of(s, "H/d").value == Approx(6));
  CHECK(contains(wave_part(flume("kind: irregular_waves, direction: [1, 0, 0], height: 0.05, "
                                 "period: 1.5, repeat: 120")),
                 "; 209 lines from 0.267 to 2 Hz, which repeat after 120 s\n"));
  CHECK(contains(wave_part(flume("kind: solitary_waves, direction: [1, 0, 0], heights: [0.03]")),
                 " s for the first wave\n"));
  CHECK(wave_part(parse(kMinimal)).empty());
}

}  // namespace pbf::scene_test
