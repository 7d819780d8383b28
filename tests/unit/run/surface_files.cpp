// Obstacles whose surfaces come from files: meshes and heights.
#include "lib/run/surface_files.h"

#include "lib/program/obstacles.h"
#include "lib/run/emit.h"
#include "lib/run/linked_files.h"
#include "lib/run/surface_warnings.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
using test::box_obj;
using test::TemporaryFolder;
namespace {

std::string surface_scene(const std::string& obstacles, const std::string& more = "") {
  return "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.05}\nbodies:\n- {shape: "
         "block, min: [0, 0, 0], max: [1, 1, 0.5]}\ntime: {step: 0.001, end: 0.01}\nobstacles:\n" +
         obstacles + "\n" + more;
}
const std::string kMesh = "- {name: a, shape: mesh, path: box.obj, scale: 0.001";
const std::string kBed = "- {name: bed, shape: heights, path: bed.csv";

std::string read_error(const TemporaryFolder& folder, const std::string& text) {
  return error_of([&] {
    Scene s = parse(text);
    read_linked_files(s, folder.path.string());
  });
}
/// A plane that rises along x, on a grid of nx by ny values over the unit square and more.
std::string slope(int nx, int ny, double rise, double margin = 0) {
  std::string text = "x,y,z\n";
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = -margin + (1 + 2 * margin) * i / (nx - 1),
                   y = -margin + (1 + 2 * margin) * j / (ny - 1);
      text +=
          std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(0.2 + rise * x) + "\n";
    }
  return text;
}
double distance_at(const Scene& s, const Double3& x) {
  const Double3 at = (1 / s.h()) * (x - s.origin());
  return s.h() * distance<3>(solids_of(s)[0], Vec3<double>{at[0], at[1], at[2]});
}

}  // namespace

TEST_CASE(
    "a mesh stands where it was scaled, turned and moved, and its distance is that of a box") {
  const TemporaryFolder folder;
  folder.write("box.obj", box_obj({400, 200, 300}));
  Scene s = parse(surface_scene(kMesh + ", turn_angle: 90, translate: [0.6, 0.1, 0.2]}"));
  read_linked_files(s, folder.path.string());
  const Double3 middle = s.obstacles[0].middle();  // the box is x 0.4 to 0.6, y 0.1 to 0.5
  CHECK(middle[0] == Approx(0.5));
  CHECK(middle[1] == Approx(0.3));
  CHECK(middle[2] == Approx(0.35));
  CHECK(distance_at(s, {0.65, 0.3, 0.35}) == Approx(0.05).margin(1e-9));
  CHECK(distance_at(s, {0.5, 0.03, 0.35}) == Approx(0.07).margin(1e-9));
  CHECK(distance_at(s, {0.5, 0.3, 0.35}) < -0.09);
  CHECK(distance_at(s, {0.5, 0.3, 0.58}) == Approx(0.08).margin(1e-9));
  REQUIRE(linked_files(s).size() == 1);
  CHECK(linked_files(s)[0].path == "box.obj");
  CHECK(linked_files(s)[0].sha256.size() == 64);
}

TEST_CASE("scenes are equal if their meshes have the same path and contents") {
  const TemporaryFolder folder, other;
  folder.write("box.obj", box_obj({400, 200, 300}));
  other.write("box.obj", box_obj({400, 200, 301}));
  const std::string text = surface_scene(kMesh + "}");
  Scene one = parse(text), same = parse(text), different = parse(text);
  CHECK(one == same);
  read_linked_files(one, folder.path.string());
  CHECK_FALSE(one == same);
  read_linked_files(same, folder.path.string());
  read_linked_files(different, other.path.string());
  CHECK(one == same);
  CHECK_FALSE(one == different);
  CHECK(parse(resolved_yaml(one)).obstacles[0].as<obstacle_keys::Mesh>().path == "box.obj");
}

TEST_CASE("a mesh that is no solid is refused at its key, with the open edges") {
  const TemporaryFolder folder;
  folder.write("box.obj", box_obj({400, 200, 300}, true));
  const std::string text = surface_scene(kMesh + "}"), said = read_error(folder, text);
  CAPTURE(said);
  CHECK(contains(said, "scene.yaml:7:32: obstacles[0].path: "));
  CHECK(contains(said, "box.obj: is not closed: 3 edges have a triangle on one side only"));
  CHECK(contains(read_error(folder, surface_scene("- {name: a, shape: mesh, path: no.stl}")),
                 "paths of meshes are relative to the folder of the scene file"));
  CHECK(contains(parse_error(surface_scene("- {name: a, shape: mesh}")), "path"));
  CHECK(
      contains(parse_error(surface_scene(kMesh + ", turn_axis: [0, 0, 0]}")), "has no direction"));
  CHECK(contains(parse_error(surface_scene(kMesh + "}", "solver: {kernels: paper}\n")),
                 "is made for kernels: consistent alone"));
  CHECK(
      contains(parse_error(surface_scene(kMesh + "}"), {"dimensions=2", "domain.max=[1, 0.05, 1]"}),
               "has no section for dimensions: 2"));
}

TEST_CASE("a pressure gauge on a mesh is refused by name") {
  CHECK(contains(
      parse_error(surface_scene(
          kMesh + "}",
          "gauges: [{name: p, kind: pressure, at: [0.4, 0.1, 0.1], on: a, radius: 0.1}]\n")),
      "the surface of a comes from a file"));
}

TEST_CASE("heights are solid below, over the whole domain, in any order of their rows") {
  const TemporaryFolder folder;
  folder.write("bed.csv", slope(5, 4, 0.3));
  Scene s = parse(surface_scene(kBed + ", translate: [0, 0, 0.05]}"));
  read_linked_files(s, folder.path.string());
  const SolidMesh& mesh = *s.obstacles[0].surface_file()->surface;
  require_closed(mesh.mesh(), "bed");
  // A slope of 0.3: the distance is the height over it times the cosine.
  const double cosine = 1 / std::hypot(1, 0.3);
  for (const double x : {0.001, 0.3, 0.9})
    for (const double y : {0.001, 0.6, 0.999})
      for (const double over : {0.11, 0.03, -0.04}) {
        CAPTURE(x, y, over);
        CHECK(distance_at(s, {x, y, 0.25 + 0.3 * x + over}) == Approx(over * cosine).margin(4e-3));
      }
  CHECK(distance_at(s, {0.5, 0.5, 0.001}) < -0.1);
  std::string text = slope(5, 4, 0.3), shuffled = "x,y,z\n", rest = text.substr(6);
  while (!rest.empty()) {  // last row first
    const std::size_t at = rest.find_last_of('\n', rest.size() - 2);
    const std::size_t begin = at == std::string::npos ? 0 : at + 1;
    shuffled += rest.substr(begin);
    rest.resize(begin);
  }
  folder.write("bed.csv", shuffled);
  Scene again = parse(surface_scene(kBed + ", translate: [0, 0, 0.05]}"));
  read_linked_files(again, folder.path.string());
  const SolidMesh& other = *again.obstacles[0].surface_file()->surface;
  CHECK(other.mesh().vertex == mesh.mesh().vertex);
  CHECK(other.mesh().triangle == mesh.mesh().triangle);
  CHECK(thin_text(s).empty());
}

TEST_CASE("a bed goes on beyond all sides of a domain that is longer along y") {
  const TemporaryFolder folder;
  std::string bed = "x,y,z\n", text = surface_scene(kBed + "}");
  for (const double y : {0.0, 1.0, 2.0})
    for (const double x : {0.0, 1.0})
      bed +=
          std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(0.4 + 0.1 * y) + "\n";
  folder.write("bed.csv", bed);
  text.replace(text.find("max: [1, 1, 1]"), 14, "max: [1, 2, 1]");
  Scene s = parse(text);
  read_linked_files(s, folder.path.string());
  const double cosine = 1 / std::hypot(1, 0.1);
  for (const double x : {0.01, 0.99})
    for (const double y : {0.01, 1.0, 1.99})
      for (const double over : {0.05, -0.04}) {
        CAPTURE(x, y, over);
        // Beyond the domain its heights are those of its edge.
        CHECK(distance_at(s, {x, y, 0.4 + 0.1 * y + over}) == Approx(over * cosine).margin(5e-3));
      }
}

TEST_CASE("heights that are no bed of the domain are refused, and name the place") {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& csv, const std::string& more = "}") {
    folder.write("bed.csv", csv);
    return read_error(folder, surface_scene(kBed + more));
  };
  const std::string whole = slope(3, 3, 0.1);
  CHECK(said(whole) == "no error");
  std::string gap = whole;
  gap.erase(gap.find("0.500000,0.500000"),
            gap.find("1.000000,0.500000") - gap.find("0.500000,0.500000"));
  CHECK(contains(said(gap), "no height at x = 0.5, y = 0.5; add it"));
  CHECK(contains(said(whole + "0.5,0.5,0.3\n"), "gives two heights at x = 0.5, y = 0.5"));
  CHECK(contains(said(slope(3, 3, 0.1, -0.1)), "has x from 0.1 to 0.9 m, and the domain goes"));
  CHECK(contains(said("x,y,z\n0,0,1\n1,0,1\n"), "two of each at least"));
  CHECK(contains(said("x,y,z\n0,0,nan\n"), "nan"));
  CHECK(contains(said("t,x\n1,2\n"), "x,y,z"));
  std::string scattered = "x,y,z\n";
  for (int k = 0; k < 200; ++k)
    scattered += std::to_string(k * 0.005) + "," + std::to_string(k * 0.00513) + ",0.1\n";
  CHECK(contains(said(scattered), "they are no grid along x and y"));
  CHECK(contains(said(whole, ", motion: {kind: velocity, velocity: [0, 0, 1]}}"),
                 "a bed of heights stands still"));
}

TEST_CASE("a bed far below or high over the domain is as good as none, or all") {
  const TemporaryFolder folder;
  folder.write("bed.csv", slope(3, 3, 0));
  for (const auto& [z, inside] : {std::pair{-5., false}, {5., true}}) {
    Scene s = parse(surface_scene(kBed + ", translate: [0, 0, " + std::to_string(z) + "]}"));
    read_linked_files(s, folder.path.string());
    CHECK((distance_at(s, {0.5, 0.5, 0.5}) < 0) == inside);
  }
}

TEST_CASE("a plate thinner than half the smoothing length is warned of, a thicker one is not") {
  const TemporaryFolder folder;
  for (const double thick : {20., 30., 60., 110.}) {  // h is 100 mm
    folder.write("box.obj", box_obj({400, 300, thick}));
    Scene s = parse(surface_scene(kMesh + ", translate: [0.2, 0.2, 0.6]}"));
    read_linked_files(s, folder.path.string());
    CAPTURE(thick, thin_text(s));
    CHECK(contains(thin_text(s), "thinner than half the smoothing length") == (thick < 40));
  }
}

}  // namespace pbf::scene_test
