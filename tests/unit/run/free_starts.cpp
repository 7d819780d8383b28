// Free bodies whose places or volumes are known only when files have been read.
#include "lib/run/free_starts.h"

#include "lib/program/obstacles.h"
#include "lib/run/linked_files.h"
#include "lib/run/start.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// d = 0.05 m, h = 0.1 m; a mesh of 0.4 x 0.2 x 0.3 m with its lower corner at `at`.
std::string start_scene(const std::string& at, const std::string& free,
                        const std::string& more = "") {
  return "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.05}\nbodies:\n- {shape: "
         "block, min: [0, 0, 0], max: [1, 1, 0.2]}\ntime: {step: 0.001, end: 0.01}\nobstacles:\n"
         "- {name: hull, shape: mesh, path: box.obj, scale: 0.001, translate: " +
         at + ", free: " + free + "}\n" + more;
}
std::string start_error(const std::string& text) {
  const test::TemporaryFolder folder;
  folder.write("box.obj", test::box_obj({400, 200, 300}));
  return error_of([&] {
    Scene s = parse(text);
    read_linked_files(s, folder.path.string());
    make_maps(s);
    require_free_starts(s);
  });
}
const std::string kMiddle = "[0.3, 0.4, 0.4]";

}  // namespace

TEST_CASE("free meshes: one too light by its mass is refused when its volume is known") {
  CHECK(start_error(start_scene(kMiddle, "{mass: 0.25}")) == "no error");
  CHECK(start_error(start_scene(kMiddle, "{mass: 0.2}")) ==
        "2 scene.yaml:7:35: obstacles[0].free (hull): makes a density of 8.333 kg/m^3, 0.0083 of "
        "fluid.rest_density: the fluid would throw about so light a body, whose coupling to it is "
        "tested down to 0.05; give at least 0.24 kg");
}

TEST_CASE("free meshes: one that reaches through a wall is refused by its vertices") {
  CHECK(start_error(start_scene("[0, 0.8, 0]", "{density: 500}")) == "no error");
  CHECK(contains(start_error(start_scene("[0.3, 0.4, -0.01]", "{density: 500}")),
                 "the body reaches 0.01 m through the wall z_min"));
  // The vertices of a tetrahedron, turned, stay within walls that its box would pass.
  const test::TemporaryFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  Scene s = parse(
      "domain: {min: [-0.36, 0, 0], max: [1, 0.5, 1]}\nfluid: {spacing: 0.05}\nbodies:\n- "
      "{shape: block, min: [0, 0, 0], max: [1, 0.5, 0.2]}\ntime: {step: 0.001, end: "
      "0.01}\nobstacles:\n"
      "- {name: t, shape: mesh, path: t.obj, scale: 0.5, turn_angle: 45, free: {density: 500}}\n");
  read_linked_files(s, folder.path.string());
  make_maps(s);
  CHECK_NOTHROW(require_free_starts(s));
  s.domain.min[0] = -0.34;
  CHECK_THROWS_WITH(require_free_starts(s), Catch::Contains("through the wall x_min"));
}

TEST_CASE("free bodies: overlaps with meshes, moving obstacles and casings are refused by name") {
  const auto beside = [](const std::string& other) {
    return start_error(start_scene(kMiddle, "{density: 500}", other));
  };
  const std::string ball = "- {name: ball, shape: sphere, radius: 0.1, center: ";
  CHECK(beside(ball + "[0.5, 0.5, 0.8]}\n") == "no error");
  CHECK(contains(beside(ball + "[0.5, 0.5, 0.75]}\n"),
                 "obstacles[0].free (hull): the body overlaps obstacles[1] (ball) by"));
  // A free ball in the mesh: the first of the two is named.
  CHECK(contains(beside(ball + "[0.5, 0.5, 0.55], free: {density: 500}}\n"),
                 "obstacles[0].free (hull): the body overlaps obstacles[1] (ball)"));
  // Where a motion has it at the start.
  const std::string moving = ball +
                             "[0.5, 0.5, 0.85], motion: {kind: sine, direction: [0, 0, 1], "
                             "amplitude: 0.1, period: 1, phase: ";
  CHECK(beside(moving + "0}}\n") == "no error");
  CHECK(contains(beside(moving + "-90}}\n"), "overlaps obstacles[1] (ball) by"));
  CHECK(contains(beside("emitters:\n- {name: jet, shape: disc, center: [0.5, 0.5, 0.6], normal: "
                        "[0, 0, -1], radius: 0.1, speed: 1}\n"),
                 "overlaps the casing of emitter jet by"));
}

TEST_CASE("free bodies: a run whose mesh overlaps something does not begin") {
  const test::TemporaryFolder folder;
  folder.write("box.obj", test::box_obj({400, 200, 300}));
  Scene s = parse(start_scene("[0.3, 0.4, -0.1]", "{density: 500}"));
  read_linked_files(s, folder.path.string());
  CHECK(contains(error_of([&] { prepare(s, folder.path.string()); }), "through the wall z_min"));
}

}  // namespace pbf::scene_test
