// time.step: auto with obstacles and tanks that move, against formulas of their motions.
#include "lib/run/linked_files.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "lib/run/linked_files.h"
#include "lib/run/load_run.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kH = 0.2;  // of kMinimal, m

std::string with_motion(const std::string& motion) {
  return kMinimal + "obstacles: [{name: a, shape: sphere, center: [0.5, 0.5, 0.8], radius: 0.1, " +
         "motion: {" + motion + "}}]\n";
}

struct Steps {
  Folder folder;
  LoadedScene load(const std::string& text, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), "time.step=auto");
    return load_scene_or_run(folder.write("s.yaml", text), more);
  }
  double step(const std::string& text, const std::vector<std::string>& more = {}) const {
    return load(text, more).scene.time.step;
  }
  std::string error(const std::string& text, const std::vector<std::string>& more = {}) const {
    return error_of([&] { step(text, more); });
  }
};

/// Cut off after two digits, by text.
double cut(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.15e", x);
  return std::atof((std::string(text, 3) + std::strchr(text, 'e')).c_str());
}

}  // namespace

TEST_CASE("auto step: the fastest obstacle moves by at most 0.2 h in a step") {
  const Steps scenes;
  const double by_gravity = cut(0.03 * std::sqrt(kH / 9.81));
  CHECK(scenes.step(kMinimal) == by_gravity);
  CHECK(scenes.step(with_motion("kind: velocity, velocity: [1, 0, 0]")) == by_gravity);
  CHECK(scenes.step(with_motion("kind: velocity, velocity: [30, 40, 0]")) == 0.0008);
  // Fastest at A 2 pi/T.
  const double fastest = 0.25 * 2 * kPi / 0.05;
  const double step =
      scenes.step(with_motion("kind: sine, direction: [1, 0, 0], amplitude: 0.25, period: 0.05"));
  CHECK(step == Approx(0.2 * kH / fastest).epsilon(0.06));  // two digits
  CHECK(step * fastest <= 0.2 * kH * 1.01);
  // One that turns: the farthest place of the ball.
  const double turning = scenes.step(with_motion("kind: velocity, angular: [0, 0, 36000]"));
  CHECK(turning <= 0.2 * kH / (0.1 * 200 * kPi));
  CHECK(turning > 0.05 * kH / (0.1 * 200 * kPi));
  // No other motion, no gravity.
  CHECK(scenes.step(with_motion("kind: velocity, velocity: [0, 0, 0.5]"), {"gravity=0"}) == 0.08);
  CHECK(scenes.step(with_motion("kind: velocity, velocity: [0, 0, 0.5]"),
                    {"gravity=0", "output.every=0.3"}) == 0.3 / 4);
}

TEST_CASE("auto step: frames are whole steps, and the end has no say, ramps and phases have") {
  const Steps scenes;
  const std::string wave = with_motion(
      "kind: sine, direction: [1, 0, 0], amplitude: 0.25, period: 0.05, ramp: 3, phase: 90");
  const double step = scenes.step(wave, {"output.every=0.1"});
  CHECK(std::fabs(0.1 / step - std::round(0.1 / step)) < 1e-9);
  CHECK(step <= 0.2 * kH / (0.25 * 2 * kPi / 0.05) * 1.01);
  for (const char* end : {"time.end=0.2", "time.end=1", "time.end=77.7"})
    CHECK(scenes.step(wave, {"output.every=0.1", end}) == step);
  // What begins behind the ramp does not see how it grew.
  CHECK(scenes.step(wave, {"output.every=0.1", "time.motion_begin=5"}) == step);
  // A ramp shorter than the period throws it: A pi/(2 ramp) where the sine is 1.
  const double thrown = scenes.step(with_motion(
      "kind: sine, direction: [1, 0, 0], amplitude: 0.25, period: 10, ramp: 0.01, phase: 90"));
  CHECK(thrown == Approx(0.2 * kH / (0.25 * kPi / 0.02)).epsilon(0.1));
}

TEST_CASE("auto step: tables of motions") {
  const Steps scenes;
  scenes.folder.write("m.csv", "t,x,y,z\n0,0,0,0\n0.5,0,0,0\n0.51,0,0,-0.5\n9,0,0,-0.5\n");
  const std::string table = with_motion("kind: file, path: m.csv");
  const double step = scenes.step(table);
  CHECK(step <= 0.2 * kH / 50);  // 0.5 m in 0.01 s
  CHECK(step > 0.05 * kH / 50);
  CHECK(scenes.step(table, {"time.end=0.1"}) == step);
  CHECK(scenes.step(table, {"gravity=0"}) == step);
  CHECK(scenes.step(table, {"time.motion_begin=1"}) == scenes.step(kMinimal));
  scenes.folder.write("m.csv", "t,x,y,z\n0,0,0,0\n9,0,0,0\n");
  CHECK(contains(scenes.error(table, {"gravity=0"}),
                 "time.step: auto goes by gravity, the velocities of bodies and motions, and "
                 "nothing moves; give a number"));
  CHECK(contains(scenes.error(with_motion("kind: file, path: none.csv")), "none.csv"));
}

TEST_CASE("auto step: in a tank that moves, what the fluid feels stands for gravity") {
  const Steps scenes;
  const std::string swing =
      kMinimal + "tank_motion: {kind: sine, direction: [1, 0, 0], amplitude: 0.1, period: 0.1}\n";
  const double a = 0.1 * std::pow(2 * kPi / 0.1, 2);  // along x, gravity along z
  CHECK(scenes.step(swing) == Approx(0.03 * std::sqrt(kH / std::hypot(a, 9.81))).epsilon(0.06));
  CHECK(scenes.step(swing, {"gravity=0"}) == Approx(0.03 * std::sqrt(kH / a)).epsilon(0.06));
  scenes.folder.write("a.csv", "t,ax,ay,az\n0,0,0,0\n0.5,400,0,0\n9,0,0,0\n");
  const std::string table = kMinimal + "tank_motion: {kind: file, path: a.csv}\n";
  CHECK(scenes.step(table, {"gravity=0"}) == Approx(0.03 * std::sqrt(kH / 400)).epsilon(0.06));
  CHECK(scenes.step(table, {"gravity=0", "time.end=0.1"}) == scenes.step(table, {"gravity=0"}));
}

TEST_CASE("auto step: what does not go with the step that motions ask for is said") {
  const Steps scenes;
  const std::string fast = with_motion("kind: velocity, velocity: [50, 0, 0]");
  CHECK(
      contains(scenes.error(fast, {"time.adaptive.step_min=0.002"}),
               "2 time.step: auto: time.adaptive.step_min: is 0.002, above time.step (0.0008 s)"));
  CHECK(contains(scenes.error(fast, {"time.end=5e6"}), "updates, at most 2147483647"));
}

TEST_CASE("auto step: a scene with motions is stored with its number and read back") {
  const Steps scenes;
  const LoadedScene loaded = scenes.load(with_motion("kind: velocity, velocity: [50, 0, 0]"));
  CHECK(loaded.auto_step);
  CHECK(contains(resolved_yaml(loaded.scene), "step: 0.0008\n"));
  Scene again = parse(resolved_yaml(loaded.scene));
  read_linked_files(again, "");
  CHECK(again == loaded.scene);
}

}  // namespace pbf::scene_test
