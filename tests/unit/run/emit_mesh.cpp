// Bodies that are meshes.
#include <algorithm>

#include "lib/run/emit.h"
#include "lib/run/start_neighbors.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
using test::box_obj;
using test::TemporaryFolder;
namespace {

constexpr Double3 kCube{200, 200, 200};  // mm

std::string scene(const std::string& more, const std::string& path = "cube.obj") {
  return "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.05}\nbodies:\n- {shape: "
         "mesh, path: " +
         path + ", scale: 0.001" + more + "}\ntime: {step: 0.001, end: 0.01}\n";
}

}  // namespace

TEST_CASE("a cube as a mesh makes the particles of a block, where it was moved and turned") {
  const TemporaryFolder folder;
  folder.write("cube.obj", box_obj(kCube));
  Scene s = parse(scene(", translate: [0.3, 0.4, 0.5], velocity: [0, 0, 2]"));
  std::string hash;
  const Particles p = emit_particles(s, folder.path.string());
  REQUIRE(p.size() == 64);
  CHECK(count_particles(s, folder.path.string()) == 64);
  CHECK(p.position[0][0] == Approx(0.325));
  CHECK(p.position[63][2] == Approx(0.675));
  CHECK(p.velocity[7] == Double3{0, 0, 2});
  REQUIRE(p.files.size() == 1);
  CHECK(p.files[0].path == "cube.obj");
  CHECK(p.files[0].sha256.size() == 64);

  s = parse(scene(", turn_axis: [0, 0, 2], turn_angle: 90, translate: [0.3, 0, 0]"));
  const Particles turned = emit_particles(s, folder.path.string());
  REQUIRE(turned.size() == 64);
  CHECK(turned.position[0][0] == Approx(0.125));
}

TEST_CASE("a mesh that makes no body of fluid is refused at its key") {
  const TemporaryFolder folder;
  folder.write("cube.obj", box_obj(kCube));
  folder.write("open.obj", box_obj(kCube, true));
  const auto said = [&](const std::string& more, const std::string& path = "cube.obj") {
    return error_of([&] { emit_particles(parse(scene(more, path)), folder.path.string()); });
  };
  CHECK(contains(said("", "open.obj"), "bodies[0].path: "));
  CHECK(contains(said("", "open.obj"), "open.obj: is not closed: 3 edges"));
  CHECK(contains(said("", "none.obj"), "none.obj"));
  CHECK(contains(said(", translate: [0.9, 0, 0]"), "is outside the domain along x"));
  CHECK(contains(parse_error(scene(", turn_axis: [0, 0, 0]")), "has no direction"));
  CHECK(contains(parse_error(scene(", min: [0, 0, 0]")), "min"));
  std::string small = scene("");
  small.replace(small.find("0.001"), 5, "1e-5");
  CHECK(contains(error_of([&] { emit_particles(parse(small), folder.path.string()); }),
                 "holds no point of a lattice of fluid.spacing"));
}

TEST_CASE("a mesh far larger than the domain is refused at once, also if it holds little fluid") {
  const TemporaryFolder folder;
  const auto said = [&](const Double3& edges) {
    folder.write("needle.obj", box_obj(edges));
    return error_of([&] { emit_particles(parse(scene("", "needle.obj")), folder.path.string()); });
  };
  CHECK(contains(
      said({1e15, 1e-6, 1e-6}),
      "bodies[0].path: " + (folder.path / "needle.obj").string() +
          ": is outside the domain along x: it reaches from 0 to 1.0e+12 m, and the domain "
          "from 0 to 1; move it, lower scale or enlarge the domain"));
  CHECK(contains(said({1e-6, 1e-6, 1e15}), "is outside the domain along z"));
  CHECK(contains(said({200, 200, 1e30}), "the scene would have"));
}

TEST_CASE("in two dimensions a mesh is cut by the plane of the particles") {
  const TemporaryFolder folder;
  folder.write("cube.obj", box_obj(kCube));
  std::string text = scene(", translate: [0.3, -0.1, 0.5]");
  text.replace(text.find("1, 1, 1"), 7, "1, 0.05, 1");
  const Scene s = parse("dimensions: 2\n" + text);
  const Particles p = emit_particles(s, folder.path.string());
  REQUIRE(p.size() == 16);
  for (const Double3& x : p.position) CHECK(x[1] == Approx(0.025));
}

TEST_CASE("a mesh and a block in one place are found to overlap") {
  const TemporaryFolder folder;
  folder.write("cube.obj", box_obj(kCube));
  std::string text = scene("");
  text.replace(text.find("time:"), 5,
               "- {shape: block, min: [0.1, 0, 0], max: [0.4, 0.2, 0.2]}\ntime:");
  const Scene s = parse(text);
  CHECK(find_overlap(StartPoints(s, folder.path.string())).inside > 0);
}

}  // namespace pbf::scene_test
