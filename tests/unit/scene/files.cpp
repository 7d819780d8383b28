// load_scene, and the scenes that come with the program.
#include <cmath>
#include <set>

#include "lib/run/emit.h"
#include "lib/run/linked_files.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

namespace fs = std::filesystem;

std::string load_error(const std::string& path) {
  return error_of([&] { load_scene(path, {}); });
}

Scene shipped_file(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return load_scene(PBF_SOURCE_DIR "/configs/" + name, overrides).scene;
}

}  // namespace

TEST_CASE("load: keeps path, text and overrides for the record") {
  const Folder folder;
  const std::string path = folder.write("a.yaml", kMinimal);
  const LoadedScene loaded = load_scene(path, {"name=b"});
  CHECK(loaded.path == path);
  CHECK(loaded.text == kMinimal);
  CHECK(loaded.overrides == std::vector<std::string>{"name=b"});
  CHECK(loaded.scene.name == "b");
}

TEST_CASE("load: missing files, directories, binary and huge files are bad input") {
  const Folder folder;
  const std::string missing = (folder.path / "no.yaml").string();
  CHECK(load_error(missing) == "2 " + missing + ": cannot be opened: No such file or directory");
  folder.write("sloshing.yaml", kMinimal);
  const std::string typed = (folder.path / "slosing.yaml").string();
  CHECK(load_error(typed) == "2 " + typed +
                                 ": cannot be opened: No such file or directory; did you " +
                                 "mean " + (folder.path / "sloshing.yaml").string() + "?");
  CHECK(contains(load_error(folder.path.string()), ": is a directory, expected a scene file"));
  CHECK(contains(load_error(folder.write("e.yaml", "")), "e.yaml: is empty"));
  CHECK(contains(load_error(folder.write("b.yaml", std::string("\x89PNG\r\n\0\1", 8))),
                 "b.yaml:1:1: is not plain text: the byte 0x89 is not UTF-8"));
  CHECK(contains(load_error(folder.write("h.yaml", std::string(5u << 20, ' '))),
                 "larger than 4 MiB"));
  const std::string typo = folder.write("t.yaml", kMinimal + "nme: x\n");
  CHECK(load_error(typo) == "2 " + typo + ":6:1: nme: unknown key, did you mean name?");
}

TEST_CASE("shipped scenes: every one is valid and makes particles inside its domain") {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(PBF_SOURCE_DIR "/configs")) {
    // Studies are lists of scenes with settings, not scenes.
    if (entry.path().extension() != ".yaml" || contains(entry.path().string(), "/configs/study/"))
      continue;
    if (entry.path().filename() == "stability.yaml") continue;  // a suite
    names.insert(entry.path().filename().string());
    CAPTURE(entry.path().string());
    const std::string text = read_file(entry.path().string());
    CHECK(text.rfind("# ", 0) == 0);    // says what it shows
    CHECK(contains(text, "pbf run "));  // and how to run it
    Scene s = load_scene(entry.path().string(), {}).scene;
    CHECK(parse(resolved_yaml(s)) == s);
    read_linked_files(s, entry.path().parent_path().string());
    const std::string dir = entry.path().parent_path().string();
    const Particles p = emit_particles(s, dir);
    CHECK(static_cast<std::int64_t>(p.size()) == count_particles(s, dir));
    bool inside = true;
    for (const Double3& x : p.position)
      for (int a = 0; a < 3; ++a)
        inside = inside && x[a] >= s.domain.min[a] && x[a] <= s.domain.max[a];
    CHECK(inside);
  }
  for (const char* name :
       {"dam_break.yaml", "minimal.yaml", "reference.yaml", "blob.yaml", "stream.yaml",
        "tank_at_rest.yaml", "sphere_drop.yaml", "double_dam_break.yaml"})
    CHECK(names.count(name) == 1);
}

TEST_CASE("dam break: over 30000 particles, 2 s, frames and pictures often enough to watch") {
  const Scene s = shipped_file("dam_break.yaml");
  CHECK(count_particles(s, "") >= 30000);
  CHECK(s.time.end == 2);
  CHECK(s.viscosity);
  REQUIRE(s.output);
  CHECK(s.output->every <= 0.02);
  REQUIRE(s.render);
  CHECK(s.render->every <= 0.1);
}

TEST_CASE("tank at rest: the block fills the floor, 24 layers deep") {
  const Scene s = shipped_file("tank_at_rest.yaml");
  CHECK(s.bodies[0].min == s.domain.min);
  CHECK(s.bodies[0].max[0] == s.domain.max[0]);
  CHECK(s.bodies[0].max[1] == s.domain.max[1]);
  CHECK(count_particles(s, "") == 12 * 12 * 24);
}

TEST_CASE("seed scenes: the numbers of the original set-up, made dimensionless") {
  for (const char* name :
       {"reference_implementation/blob.yaml", "reference_implementation/stream.yaml"}) {
    const Scene s = shipped_file(name);
    const double mass = 1.0 / 30, h = 0.1;
    CAPTURE(name);
    CHECK(s.h() == h);
    CHECK(s.fluid.mass == mass);
    CHECK(s.fluid.spacing == Approx(std::cbrt(mass / 1000)).epsilon(1e-14));
    CHECK(s.solver.cfm == Approx(1e5 * mass * h * h).epsilon(1e-15));
    CHECK(s.tensile->k == Approx(1e-4 / (h * h)).epsilon(1e-14));
    CHECK(s.time.step == 1.0 / 60);
    CHECK(std::llround(s.time.end / s.time.step) == 500);
    CHECK(s.solver.kernels == KernelMode::paper);
    CHECK(s.solver.constraint == ConstraintMode::two_sided);
    CHECK(s.solver.boundary == BoundaryMode::clamp);
    CHECK(count_particles(s, "") == 16384);
    for (int n = 1024; n <= 131072; n *= 2)
      CHECK(count_particles(shipped_file(name, {"bodies.0.count=" + std::to_string(n)}), "") == n);
  }
}

}  // namespace pbf::scene_test
