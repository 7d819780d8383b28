// Study files: what runs they make, and what is said of wrong ones.
#include <filesystem>
#include <iterator>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/study_support.h"

using namespace pbf;
using pbf::test::StudyFolder;

TEST_CASE("a study makes every combination of its grid for every variant") {
  const StudyFolder folder;
  const Study s = folder.study(
      "set: {fluid.rest_density: 900}\n"
      "variants:\n  - {name: paper, set: {solver.kernels: paper}}\n  - {name: plain}\n"
      "grid:\n  - {solver.iterations: [1, 4]}\n"
      "  - {time.step: [0.002, 0.001, 0.0005], measure_every: [5, 10, 20]}\n");
  REQUIRE(s.members.size() == 12);
  CHECK(s.keys == std::vector<std::string>{"solver.iterations", "time.step", "measure_every"});
  for (std::size_t k = 0; k < 12; ++k) {
    const StudyMember& m = s.members[k];
    CHECK(m.variant == (k < 6 ? "paper" : "plain"));
    CHECK((m.scene.solver.kernels == KernelMode::paper) == (k < 6));
    CHECK(m.scene.solver.iterations == (k % 6 < 3 ? 1 : 4));
    CHECK(m.scene.time.step == 0.002 / (1 << k % 3));
    CHECK(m.scene.measure_every == 5 << k % 3);
    CHECK(m.scene.fluid.rest_density == 900);
  }
  CHECK(s.members[10].label == "plain solver.iterations=4 time.step=0.001");
  CHECK(s.members[10].values == std::vector<std::string>{"4", "0.001", "10"});
}

TEST_CASE("the energy of a run may rise by 1 %, or by what the study or its variant says") {
  const StudyFolder folder;
  const auto limits = [&](const std::string& text) {
    std::vector<double> of;
    for (const StudyMember& m : folder.study(text).members) of.push_back(m.energy_limit);
    return of;
  };
  CHECK(limits("") == std::vector<double>{0.01});
  CHECK(limits("energy_limit: 0.2\n") == std::vector<double>{0.2});
  const std::string variants =
      "variants:\n  - {name: a}\n  - {name: b, energy_limit: 0.03}\n"
      "  - {name: c, energy_limit: 0}\ngrid: {solver.iterations: [1, 2]}\n";
  CHECK(limits(variants) == std::vector<double>{0.01, 0.01, 0.03, 0.03, 0, 0});
  CHECK(limits(variants + "energy_limit: 2\n") == std::vector<double>{2, 2, 0.03, 0.03, 0, 0});
}

TEST_CASE("a block as grid varies every key by itself, and --set comes before variants and grid") {
  const StudyFolder folder;
  const std::string path = folder.write(
      "s.yaml",
      "name: n\nscene: scene.yaml\nset: {precision: double}\n"
      "grid: {solver.iterations: [1, 2], viscosity: [off, {xsph: 0.1}], gravity: [[0, 0, -1]]}\n");
  const Study s =
      load_study(path, {"precision=float", "solver.iterations=9", "fluid.spacing=0.08"});
  REQUIRE(s.members.size() == 4);
  CHECK(s.name == "n");
  for (const StudyMember& m : s.members) {
    CHECK(m.scene.precision == Precision::single);
    CHECK(m.scene.fluid.spacing == 0.08);
    CHECK(m.scene.gravity == Double3{0, 0, -1});
  }
  CHECK(s.members[1].scene.solver.iterations == 1);
  CHECK(s.members[1].scene.viscosity->xsph == 0.1);
  CHECK(s.members[1].values == std::vector<std::string>{"1", "{xsph: 0.1}", "[0, 0, -1]"});
  CHECK_FALSE(s.members[2].scene.viscosity);
}

TEST_CASE("without grid and variants a study is one run") {
  const StudyFolder folder;
  const Study s = folder.study("name: alone\n");
  REQUIRE(s.members.size() == 1);
  CHECK(s.members[0].label == "alone");
  CHECK(s.errors == std::vector<std::string>{"compression_mean"});
  CHECK(s.repeats == 3);
}

TEST_CASE("what is wrong with a study is said with file, line and column, all at once") {
  const StudyFolder folder;
  folder.write("bad.csv", "T,Z\n1,2\n2,x\n");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"grid: {solver.iteratons: [1, 2]}", ":2:27: solver.iteratons: unknown key, did you mean"},
      {"grid: {solver.iterations: [1, -2]}", ":2:31: solver.iterations: \"-2\" is out of range"},
      {"grid: {solver.iterations: 4}",
       ":2:27: grid.solver.iterations: is \"4\", expected the list"},
      {"grid: {solver.iterations: []}", "expected the list of its values"},
      {"grid:\n  - {solver.iterations: [1], time.step: [0.001, 0.002]}", "vary together"},
      {"grid:\n  - {time.step: [0.001]}\n  - {time.step: [0.002]}",
       "grid.time.step: is given twice"},
      {"grid: 4", "grid: is \"4\", expected keys"},
      {"grids: {}", ":2:1: grids: unknown key, did you mean grid?"},
      {"set: {..: 1}", "is no path of keys"},
      {"set: 3", "expected keys of the scene"},
      {"variants: []", "expected a list of {name"},
      {"variants:\n  - {set: {}}", "without a name"},
      {"variants:\n  - {name: a}\n  - {name: a}", "two entries named a"},
      {"variants:\n  - {nme: a}", "variants.nme: unknown key, did you mean name?"},
      {"variants:\n  - {name: a, energy_limit: 3 %}",
       ":3:29: variants.energy_limit: \"3 %\" is not a number"},
      {"variants:\n  - {name: a, energy_limit: -1}",
       "variants.energy_limit: \"-1\" is out of range, 0 .. "},
      {"energy_limit: [0.01]", ":2:15: energy_limit: a list of 1"},
      {"clock: sun", "clock: is \"sun\", expected wall or cpu"},
      {"clock: cpu\nset: {backend: cuda}", ":2:8: clock: cpu does not count the time of a GPU"},
      {"repeats: 0", "repeats: \"0\" is out of range, 1 .. 1000"},
      {"repeats: 1.5", ":2:10: repeats: \"1.5\" is not a whole number"},
      {"repeats: -1", "repeats: \"-1\" is out of range"},
      {"repeats: 1e4", "repeats: \"1e4\" is out of range"},
      {"repeats: 99999999999", "repeats: \"99999999999\" is out of range"},
      {"repeats: 99999999999999999999", "is too large"},
      {"repeats: ''", "repeats: \"\" is not a number"},
      {"repeats:", "repeats: "},
      {"repeats: [1]", "repeats: a list of 1"},
      {"targets: 0.1", "targets: is \"0.1\", expected a list"},
      {"targets: [nan]", "targets: \"nan\""},
      {"error: compresion_mean", "did you mean compression_mean?"},
      {"error: projection_rms", "is no measure of this study"},
      {"projection: [0.2]\nerror: projection_rms",
       ":2:13: projection: studies no longer measure the distance from the exact projection; the "
       "page lib/solver/DIAGNOSTICS.md has it. Remove the key"},
      {"from: 1", ":2:7: from: 1 s is not before time.end (0.04 s)"},
      {"front: {axis: w, length: 1}", "expected x, y or z"},
      {"front: {axis: x}", "front.length: is missing"},
      {"front: {length: 1, data: [no.csv]}", "no.csv: cannot be opened: No such file"},
      {"front: {length: 1, data: [bad.csv]}", "bad.csv:3: \"x\""},
      {"repeats: 1\nrepeats: 2", "repeats: is given twice"},
      {"grid: {solver.iterations: [1, 2\n", "not valid YAML"}};
  for (const auto& [text, message] : cases) {
    CAPTURE(text, message);
    try {
      folder.study(text + "\n");
      FAIL_CHECK("accepted");
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::bad_input);
      CAPTURE(e.what());
      CHECK(std::string(e.what()).find(message) != std::string::npos);
      CHECK(std::string(e.what()).find("study.yaml:") != std::string::npos);
    }
  }
  const auto error = [&](const std::string& path) {
    try {
      load_study(path, {});
    } catch (const Error& e) {
      return std::to_string(int(e.code())) + " " + e.what();
    }
    return std::string("accepted");
  };
  const std::string none = folder.write("none.yaml", "name: a\n");
  CHECK(error(none) == "2 " + none +
                           ": scene: is missing: the scene to vary, a path from this "
                           "file's folder");
  const std::string gone = folder.write("gone.yaml", "scene: no.yaml\n");
  CHECK(error(gone).find("no.yaml: cannot be opened") != std::string::npos);
  CHECK(error(folder.write("huge.yaml",
                           "scene: scene.yaml\ngrid: {solver.iterations: [1, 2, 3, 4, "
                           "5, 6, 7, 8, 9, 10], time.step: [1, 2, 3, 4, 5, 6, 7, 8, "
                           "9, 10], time.end: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "
                           "measure_every: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], threads: "
                           "[1, 2]}\n"))
            .find("makes more than 10000 runs") != std::string::npos);
}

TEST_CASE("repeats of a study are read as numbers of scenes are") {
  const StudyFolder folder;
  CHECK(folder.study("repeats: 1e2\n").repeats == 100);
  CHECK(folder.study("repeats: 1000\n").repeats == 1000);
}

TEST_CASE("shipped studies are valid and say how to run them") {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PBF_SOURCE_DIR "/configs/study")) {
    CAPTURE(entry.path().string());
    CHECK(load_study(entry.path().string(), {}).members.size() > 2);
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    CHECK(text.rfind("# ", 0) == 0);
    CHECK(text.find("pbf study configs/study/" + entry.path().filename().string()) !=
          std::string::npos);
    ++found;
  }
  CHECK(found >= 5);
}
