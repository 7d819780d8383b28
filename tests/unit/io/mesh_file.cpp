// Meshes from files: three formats of one body, and what is wrong with others.
#include "lib/io/mesh_file.h"

#include <cstring>

#include "tests/support/catch.h"
#include "tests/support/meshes.h"
#include "tests/support/scene_samples.h"

using namespace pbf;
using namespace pbf::scene_test;

namespace {

/// Of a unit cube: bits of k are x, y, z.
Double3 corner(int k) { return {double(k & 1), double(k >> 1 & 1), double(k >> 2)}; }

std::string obj() {
  std::string text = "# a cube\nmtllib none.mtl\no cube\n";
  for (int k = 0; k < 8; ++k) {
    const Double3 x = corner(k);
    text += "v " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) +
            "\r\n";
  }
  text += "vn 0 0 1\nvt 0 0\ng all\ns off\n";
  for (const auto& f : test::kBoxFaces)
    text += "f " + std::to_string(f[0] + 1) + "/1/1 " + std::to_string(f[1] + 1) + "//1 " +
            std::to_string(f[2] - 8) + "\n";
  return text;
}
std::string ascii() {
  std::string text = "solid my cube\n";
  for (const auto& f : test::kBoxFaces) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const int k : f) {
      const Double3 x = corner(k);
      text += "   vertex " + std::to_string(x[0]) + " +" + std::to_string(x[1]) + " " +
              std::to_string(x[2]) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid my cube\n";
}
std::string binary(const char* header = "solid, says the header") {
  std::string bytes(84, '\0');
  std::memcpy(bytes.data(), header, std::strlen(header));
  const std::uint32_t n = 12;
  std::memcpy(bytes.data() + 80, &n, sizeof n);
  for (const auto& f : test::kBoxFaces) {
    float value[12] = {};
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) value[3 + 3 * k + a] = float(corner(f[k])[std::size_t(a)]);
    bytes.append(reinterpret_cast<const char*>(value), sizeof value);
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace

TEST_CASE("a cube is read from binary STL, ASCII STL and OBJ as 8 vertices and 12 triangles") {
  for (const std::string& bytes : {binary(), binary(""), ascii(), obj()}) {
    const TriangleMesh m = read_mesh(bytes, "cube");
    CHECK(m.vertex.size() == 8);
    CHECK(m.triangle.size() == 12);
    CHECK(volume_of(m) == Approx(1));
    CHECK_NOTHROW(require_closed(m, "cube"));
  }
}

TEST_CASE(
    "a face of OBJ with many corners becomes triangles, -0 is 0, degenerate ones are left out") {
  const TriangleMesh m = read_mesh(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -0 0 0\nf 1 2 3 4\nf 1 5 2\nf -5 -4 -3\n", "plate");
  CHECK(m.vertex.size() == 4);
  CHECK(m.triangle == std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}});
}

TEST_CASE("what is wrong with a mesh is said with its line or triangle") {
  const auto said = [](const std::string& bytes) {
    return error_of([&] { read_mesh(bytes, "m"); }).substr(2);
  };
  CHECK(said("") == "m: is empty, expected STL (binary or ASCII) or OBJ");
  CHECK(said("root:x:0:0:secret\n") == "m: is no mesh, expected STL (binary or ASCII) or OBJ");
  CHECK(said("v 1 2\n") == "m:1: a vertex needs x, y and z");
  CHECK(said("\nv 1 2 3,4\n") == "m:2: \"3,4\" is not a number");
  CHECK(said("v 1 2 nan\n") == "m:1: a coordinate is not finite");
  CHECK(said("v 1 2 1e999\n") == "m:1: \"1e999\" does not fit a double");
  CHECK(said("v 1 2 3\nf 1 1\n") == "m:2: a face needs at least three vertices");
  CHECK(said("v 1 2 3\nf 1 2 1\n") ==
        "m:2: vertex \"2\": the file has 1 up to here, the first is 1");
  CHECK(said("v 1 2 3\nf 1 0 1\n") ==
        "m:2: vertex \"0\": the file has 1 up to here, the first is 1");
  CHECK(said("v 1 2 3\nf 1 -2 1\n") ==
        "m:2: vertex \"-2\": the file has 1 up to here, the first is 1");
  CHECK(said("v 1 2 3\nf 1 a 1\n") == "m:2: \"a\" is not the number of a vertex");
  CHECK(said("solid x\nfacet\n") == "m:2: expected facet normal X Y Z, or endsolid");
  CHECK(said("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n") ==
        "m:4: expected vertex X Y Z");
  CHECK(said("solid x\nfacet normal 0 0 1\nouter loop\n") ==
        "m: ends where vertex X Y Z should stand");
  CHECK(said(ascii().substr(0, ascii().size() - 17)) ==
        "m: ends before endsolid; the file is not whole");
  std::string bytes = binary();
  const float nan = std::nanf("");
  std::memcpy(bytes.data() + 84 + 50 * 3 + 16, &nan, sizeof nan);
  CHECK(said(bytes) == "m: triangle 3: a coordinate is not finite");
  CHECK(said(binary("").substr(0, 600)) ==
        "m: is no mesh, expected STL (binary or ASCII) or OBJ; as binary STL it would say 12 "
        "triangles, which take 684 bytes, and the file has 600");
}
