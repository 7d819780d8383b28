// Mistakes of writing are called by their name: units, commas, spaces, indentation, other files.
#include "lib/scene/remedies.h"

#include "lib/scene/file_kind.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

struct Slip {
  std::string text, message;
};

std::string refused_file(const std::string& text, const std::string& wanted) {
  const Folder folder;
  const std::string path = folder.write("given", text);
  const std::string error = error_of([&] { load_tree(path, wanted); });
  const std::size_t at = error.find(path + ": ");
  return at == std::string::npos ? error : error.substr(at + path.size() + 2);
}

}  // namespace

TEST_CASE("writing: a direction by its letter, a list without brackets") {
  CHECK(axis_remedy("z") == "; write [0, 0, 1]");
  CHECK(axis_remedy("-X") == "; write [-1, 0, 0]");
  CHECK(axis_remedy("+y") == "; write [0, 1, 0]");
  for (const char* text : {"", "-", "w", "xy", "--z", "2"}) CHECK(axis_remedy(text) == "");
  CHECK(list_remedy("0 0 -9.81", 3) == "; write [0, 0, -9.81]");
  CHECK(list_remedy("(1, 2; 3)", 3) == "; write [1, 2, 3]");
  for (const char* text : {"", "0 0", "0 0 0 0", "a b c", "1 2 3m"})
    CHECK(list_remedy(text, 3) == "");
}

TEST_CASE("writing: a number with a unit, a comma, separators, a formula") {
  const std::string s = "; write the number without a unit, the key is in s";
  const std::vector<std::pair<Slip, std::string>> cases{
      {{"2 ms", s + ": 0.002"}, "s"},
      {{"2ms", s + ": 0.002"}, "s"},
      {{"1e-3s", s + ": 0.001"}, "s"},
      {{"1.5 min", s + ": 90"}, "s"},
      {{"5 ticks", s}, "s"},
      {{"0.5m", "; write the number without a unit, the key is in m: 0.5"}, "m"},
      {{"20 mm", "; write the number without a unit, the key is in m: 0.02"}, "m"},
      {{"1 g/cm^3", "; write the number without a unit, the key is in kg/m^3: 1000"}, "kg/m^3"},
      {{"5 %", "; write the number without a unit: 0.05"}, ""},
      {{"45°", "; write the number without a unit, the key is in degrees: 45"}, "degrees"},
      {{"9.81 m/s2", "; write the number without a unit, the key is in m/s^2: 9.81"}, "m/s^2"},
      {{"9.81 m/s²", "; write the number without a unit, the key is in m/s^2: 9.81"}, "m/s^2"},
      {{"1000 kg/m3", "; write the number without a unit, the key is in kg/m^3: 1000"}, "kg/m^3"},
      {{"30 rpm", "; write the number without a unit, the key is in degrees/s: 180"}, "degrees/s"},
      {{"5 cm", "; write the number without a unit, the key is in m or degrees: 0.05"},
       "m or degrees"},
      {{"5 deg", "; write the number without a unit, the key is in m or degrees: 5"},
       "m or degrees"},
      {{"5 kg", "; write the number without a unit, the key is in m or degrees"}, "m or degrees"},
      {{"2 Hz", "; the key is a time in s, 1/frequency: 0.5"}, "s"},
      {{"0 Hz", s}, "s"},
      {{"2 mm", s}, "s"},
      {{"0,5", "; decimals take a point: write 0.5"}, "m"},
      {{"-0,25", "; decimals take a point: write -0.25"}, "m"},
      {{"1,000", "; decimals take a point: write 1.000, or 1000 if thousands were meant"}, "m"},
      {{"1_000", "; write it in one piece: 1000"}, ""},
      {{"1 000", "; write it in one piece: 1000"}, ""},
      {{"1/60", "; formulas are not computed: write the result"}, "s"},
      {{"1,2,3", ""}, "m"},
      {{",5", ""}, "m"},
      {{"many", ""}, "m"},
      {{"", ""}, "m"},
      {{"-", ""}, "m"},
      {{"e", ""}, "m"},
      {{"0x10", ""}, "m"},
      {{"0o17", ""}, "m"},
      {{"0b1", ""}, "m"},
      {{"1.2.3", ""}, "m"},
  };
  for (const auto& [c, unit] : cases) {
    CAPTURE(c.text);
    CHECK(number_remedy(c.text, unit) == c.message);
  }
}

TEST_CASE("writing: slips in a scene") {
  const std::vector<Slip> cases{
      {"output: {every: 20 ms}\n",
       "scene.yaml:6:17: output.every: expected a number, got \"20 ms\"; write the number without "
       "a unit, the key is in s: 0.02"},
      {"output: {every: \"20 ms\"}\n",
       "output.every: expected a number, got \"20 ms\"; write the number without a unit, the key "
       "is in s: 0.02"},
      {"output: {every: \"0.02\"}\n", "got \"0.02\" in quotes; remove them"},
      {"gravity: [0, 0, -9,81]\n",
       "expected 3 numbers [x, y, z], got a list of 4; commas part the numbers, decimals take a "
       "point"},
      {"gravity: [0, 0, -9.81 m/s^2]\n",
       "element 2: expected a number, got \"-9.81 m/s^2\"; write the number without a unit, the "
       "key "
       "is in m/s^2: -9.81"},
      {"solver: {iterations:4, sor: 1}\n",
       "solver.iterations:4: unknown key; a space is missing behind \"iterations:\""},
      {"solver:\n  iterations:4\n", "a space is missing behind \"iterations:\""},
      {"solver:\n  iterations:4\n  sor: 1\n",
       "a space is missing behind \"iterations:\" on line 7"},
      {"name:x\nthreads: 1\n", "a space is missing behind \"name:\" on line 6"},
      {"output:{every: 0.1}\n", "a space is missing behind \"output:\""},
      {"solver: {iterations:{4}, sor: 1}\n", "a space is missing behind \"iterations:\""},
      {"gauges: [{name: g, at:[0.2,\n  0.2]}]\n", "a space is missing behind \"at:\" on line 6"},
      {"solver: {iterations 4}\n",
       "iterations 4: unknown key; a colon is missing behind \"iterations\""},
      {"solver {iterations: 4}\n", "a colon is missing behind \"solver\""},
      {"gravity: [0, 0}\n", "a comma, a colon or a closing bracket is missing on this line"},
      {"gauges:\n  -{name: g, kind: level}\n", "a space is missing behind the \"-\" on line 7"},
      {"solver\n  iterations: 4\n", "a colon is missing behind \"solver\" on line 6"},
      {"solver: {iterations: 4\nthreads: 1\n", "the { on line 6 is not closed"},
      {"gravity: [0, 0\nthreads: 1\n", "the [ on line 6 is not closed"},
      {"solver:\niterations: 4\n", "got nothing; its keys stand below it, indented by two spaces"},
      {"solver:\n  iterations: 4\n   sor: 1\n",
       "line 8 is indented deeper than the line before it, which has a value of its own"},
      {"solver:\n    iterations: 4\n  sor: 1\n", "line 8 is indented like no line above it"},
      {" name: x\n", "line 6 is indented deeper than the line before it"},
  };
  for (const Slip& c : cases) {
    CAPTURE(c.text, parse_error(kMinimal + c.text));
    CHECK(contains(parse_error(kMinimal + c.text), c.message));
  }
  CHECK(contains(parse_error("# about\nname:x   # about\n" + kMinimal),
                 "scene.yaml:3:1: not valid YAML: the lines above end before this one; a space is "
                 "missing behind \"name:\" on line 2"));
  CHECK(contains(parse_error("solver {iterations: 4, sor: 1}\n" + kMinimal),
                 "a colon is missing behind \"solver\" on line 1"));
  CHECK(contains(parse_error(kMinimal + "---\nname: x\n"),
                 "scene.yaml:6:1: a second document starts here; a scene file holds one"));
  CHECK(contains(parse_error("step:0.002\n"), "a space is missing behind \"step:\""));
}

TEST_CASE("writing: nothing is said of what is written well") {
  CHECK(missing_space("https://x.org") == "");
  CHECK(missing_space("a: b") == "");
  CHECK(missing_space("12:30") == "");
  CHECK(missing_space(":") == "");
  CHECK(missing_space("x:") == "");
  CHECK(missing_space("") == "");
  for (const char* text : {"", "every", " x", "1 2", "[0, 1]"}) CHECK(missing_colon(text) == "");
  CHECK(layout_remedy("", 0) == "");
  CHECK(layout_remedy("\n\n", 5) == "");
  // Lists in the column of their key, brackets over lines, comments, entries of lists.
  CHECK(layout_remedy(kMinimal + "obstacles:\n- name: a\n  shape: sphere\n  # about\n  radius: 1\n"
                                 "gravity: [0,\n   0,\n 1]\nname: \"a: b\"\n",
                      99) == "");
}

TEST_CASE("writing: a file that another command takes") {
  const std::string study = "scene: a.yaml\ngrid: [{time.step: [1, 2]}]\n";
  const std::string suite = "cases:\n  - {name: a}\n", list = "a.yaml\n# b\nb.yaml time.step=2\n";
  CHECK(contains(refused_file(study, "scene"), "is a study, expected a scene; pbf study "));
  CHECK(contains(refused_file(suite, "scene"),
                 "is a stability suite, expected a scene; pbf stability --suite "));
  CHECK(contains(refused_file(list, "scene"), "is a list of runs, expected a scene; pbf batch "));
  CHECK(contains(refused_file(list, "study"), "is a list of runs, expected a study; pbf batch "));
  CHECK(contains(refused_file(kMinimal, "study"), "is a scene, expected a study; pbf run "));
  CHECK(contains(refused_file(kMinimal, "stability suite"),
                 "is a scene, expected a stability suite; pbf run "));
  CHECK(contains(refused_file(suite, "study"), "is a stability suite, expected a study"));
  CHECK(refused_file(kMinimal, "scene") == "no error");
  CHECK(refused_file(study, "study") == "no error");
  CHECK(refused_file(suite, "stability suite") == "no error");
  CHECK(refused_file("scen: a.yaml\n", "study") == "no error");  // its reader says more
  CHECK(other_text("", "x", "scene") == "");
  CHECK(other_text("a.yaml\nb: 1\n", "x", "scene") == "");
  CHECK(other_text("a.yaml twice\n", "x", "scene") == "");
}

}  // namespace pbf::scene_test
