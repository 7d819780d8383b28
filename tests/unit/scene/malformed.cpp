// Every kind of malformed scene gets a message that names the place, the key and the remedy.
#include <algorithm>
#include <random>

#include "lib/scene/keys.h"
#include "lib/scene/suggest.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

struct Case {
  std::string text, message;
};

/// Appended to the minimal scene, so line 6 is theirs.
const std::vector<Case> kAppended{
    // unknown and misplaced keys
    {"solver: {iteratons: 4}\n",
     "scene.yaml:6:10: solver.iteratons: unknown key, did you mean solver.iterations?"},
    {"iterations: 4\n", "6:1: iterations: unknown key, did you mean solver.iterations?"},
    {"slover: {}\n", "6:1: slover: unknown key, did you mean solver?"},
    {"render: {camera: {fvo: 3}}\n",
     "render.camera.fvo: unknown key, did you mean render.camera.fov?"},
    {"render: {style: surfaces}\n",
     "6:17: render.style: \"surfaces\" is not one of spheres, surface; did you mean surface?"},
    {"qqqqqqqqqqqq: 1\n", "6:1: qqqqqqqqqqqq: unknown key"},
    {"\"two\\nlines\": 1\n", "6:1: two\\nlines: unknown key"},
    {"Gravity: [0, 0, 0]\n", "did you mean gravity?"},
    {"<<: 1\n", "<<: unknown key"},
    {"shape: block\n", "shape: unknown key"},
    // doubled keys
    {"gravity: [0, 0, 0]\ngravity: [0, 0, 1]\n",
     "7:1: gravity: given twice, first at scene.yaml:6:1; remove one"},
    {"domain: {}\n", "domain: given twice, first at scene.yaml:1:1"},
    {"solver: {iterations: 4}\nsolver.iterations: 9\n",
     "7:1: solver.iterations: given twice, first at scene.yaml:6:22; remove one"},
    {"solver.iterations: 9\nsolver: {iterations: 4}\n",
     "7:10: solver.iterations: given twice, first at scene.yaml:6:20; remove one"},
    {"solver.iterations: 9\nsolver.iterations: 4\n", "given twice, first at scene.yaml:6:1"},
    // paths in one word into what is not there
    {"tensile.k: 5\n", "6:1: tensile.k: belongs into the block tensile; write it there"},
    {"render.camera.fov: 40\n", "render.camera.fov: belongs into the block render.camera"},
    {"bodies[].count: 5\n", "bodies[].count: belongs into an entry of bodies; write it there"},
    // names that lead out of the folder of runs
    {"name: ../../evil\n", "6:7: name: is \"../../evil\", and runs are kept in out/<name>"},
    {"name: /etc\n", "runs are kept in out/<name>"},
    {"name: a/b\n", "give a word without slashes"},
    {"name: ..\n", "name: is \"..\""},
    {"name: .\n", "name: is \".\""},
    {"name: \"\"\n", "name: "},
    // wrong types
    {"solver: {iterations: many}\n",
     "6:22: solver.iterations: expected a whole number, got \"many\""},
    {"solver: {iterations: \"4\"}\n", "in quotes; remove them"},
    {"solver: {iterations: 2.5}\n", "\"2.5\" is not a whole number"},
    {"solver: {iterations: [4]}\n", "expected a whole number, got a list of 1"},
    {"solver: {iterations: 0x10}\n", "expected a whole number, got \"0x10\""},
    {"solver: {iterations: 0o17}\n", "expected a whole number, got \"0o17\""},
    {"solver: {iterations: 1_000}\n", "got \"1_000\"; write it in one piece: 1000"},
    {"solver: {iterations: 1e30}\n", "too large"},
    {"solver: {iterations: 99999999999999999999}\n", "too large"},
    {"solver: {iterations:}\n", "has no value"},
    {"solver: {cfm: 1,5}\n",
     "solver.5: unknown key; decimals take a point, a comma begins the next key"},
    {"solver: {fused: yes}\n", "solver.fused: expected true or false, got \"yes\""},
    {"solver: {fused: 1}\n", "expected true or false"},
    {"solver: 4\n", "solver: expected a block {iterations: ...}, got \"4\""},
    {"solver: [4]\n", "expected a block {iterations: ...}, got a list of 1"},
    {"solver: off\n", "solver: expected a block"},
    {"gravity: -9.81\n", "6:10: gravity: is -9.81, and one number is its magnitude"},
    {"gravity: [0, -9.81]\n", "gravity: expected 3 numbers [x, y, z], got a list of 2"},
    {"gravity: [0, 0, down]\n", "gravity: element 2: expected a number, got \"down\""},
    {"gravity: {x: 0}\n", "6:11: gravity.x: unknown key"},
    {"name: [a]\n", "name: expected text"},
    {"name: \"\"\n", "name: is empty"},
    {"name: \"a\\nb\"\n", "holds a line break or a tab, expected one line"},
    {"output: {fields: velocity}\n", "expected a list of words"},
    {"output: {fields: [velocty]}\n",
     "\"velocty\" is not one of velocity, density; did you mean velocity?"},
    {"output: {fields: [density, density]}\n", "is listed twice"},
    {"render: {range: [1]}\n", "expected 2 numbers [a, b] or auto"},
    // choices
    {"backend: gpu\n", "backend: \"gpu\" is not one of cpu, cuda; did you mean cuda?"},
    {"precision: single\n",
     "precision: \"single\" is not one of float, double; did you mean float?"},
    {"solver: {kernels: papr}\n", "did you mean paper?"},
    {"solver: {boundary: [clamp]}\n", "is not one of density, clamp"},
    // not finite, denormal, out of range
    {"gravity: [0, 0, .nan]\n", "gravity: element 2: \".nan\" is not finite"},
    {"gravity: [0, -.inf, 0]\n", "\"-.inf\" is not finite"},
    {"gravity: [nan, 0, 0]\n", "is not finite"},
    {"gravity: [0, 0, 1e308]\n", "out of range"},
    {"gravity: [0, 0, 1e309]\n", "too large"},
    {"gravity: [0, 0, 1e-310]\n", "too small"},
    {"gravity: [0, 0, 1e-400]\n", "too small"},
    {"solver: {iterations: -1}\n", "\"-1\" is out of range, allowed: 0 .. 100000"},
    {"solver: {sor: 0}\n", "out of range, allowed: > 0 .. 2"},
    {"solver: {velocity_damping: 1.5}\n", "out of range, allowed: 0 .. 1"},
    {"tensile: {delta_q: 1}\n", "out of range, allowed: > 0 .. < 1"},
    {"tensile: {n: 17}\n", "out of range, allowed: 1 .. 16"},
    {"viscosity: {xsph: 11}\n", "out of range, allowed: 0 .. 10"},
    {"render: {size: [8, 8]}\n", "element 0: \"8\" is out of range, allowed: 16 .. 16384 px"},
    {"render: {camera: {fov: 180}}\n", "out of range, allowed: 1 .. 170 deg"},
    {"render: {radius: 0}\n", "out of range, allowed: > 0 .. 1.0e+09 | auto m"},
    {"threads: 0\n", "threads: \"0\" is out of range, allowed: 1 .. 4096 | auto"},
    {"measure_every: 0\n", "out of range, allowed: 1 .. "},
    // optional blocks
    {"viscosity:\n", "viscosity: expected a block {xsph: ...}, got nothing; write {} or on for on"},
    {"viscosity: full\n", "write {} or on for on with the defaults, off for off"},
    {"render: {camera: off}\n", "render.camera: expected a block"},
    // between keys
    {"output: {every: 0.001}\n", "output.every: is 0.001, below time.step (0.01 s)"},
    {"render: {every: 0.001}\n", "render.every: is 0.001, below time.step"},
    {"output: {every: 0.5}\nrender: {every: 0.1}\n",
     "render.every: is 0.1, below output.every (0.5 s)"},
    {"render: {range: [2, 2]}\n", "render.range: the lower end 2 is not below the upper end 2"},
    {"render: {camera: {position: [1, 1, 1], target: [1, 1, 1]}}\n", "is where the camera is"},
    {"solver: {wall_margin: 0.5}\n", "solver.wall_margin: is 0.5, but must be below half"},
    // YAML itself
    {"\tgravity: [0, 0, 0]\n", "scene.yaml:6:1: a tab indents this line"},
    {"  - x\n  y: [\n", "not valid YAML"},
    {"name: 'open\n", "illegal EOF in scalar"},
    {"name: \"open\n\n", "illegal EOF in scalar"},
    {"name: a: b\n", "6:8: not valid YAML"},
    {"---\nname: x\n", "a second document starts here"},
    {"name: &anchor x\n", "6:7: anchors (&name) are not supported"},
    {"name: *alias\n", "not valid YAML"},
    {"name: !!str x\n", "tags (!name) are not supported"},
    {"? [a, b]\n: 1\n", "a key must be a word"},
};

const std::vector<Case> kBodies{
    {"[]", "scene.yaml:3:9: bodies: expected a list of at least one body"},
    {"{shape: block}", "bodies: expected a list of at least one body"},
    {"[block]", "bodies[0]: expected a body such as {shape: block,"},
    {"[{min: [0, 0, 0], max: [1, 1, 1]}]",
     "3:10: bodies[0].shape: missing; required: block | sphere | random_box | file"},
    {"[{shape: blok, min: [0, 0, 0], max: [1, 1, 1]}]", "bodies[0].shape: \"blok\" is not one of"},
    {"[{shape: block, min: [0, 0, 0]}]", "bodies[0].max: missing; required, in m"},
    {"[{shape: sphere, center: [0.5, 0.5, 0.5]}]", "bodies[0].radius: missing"},
    {"[{shape: random_box, min: [0, 0, 0], max: [1, 1, 1]}]", "bodies[0].count: missing"},
    {"[{shape: file}]", "bodies[0].path: missing"},
    {"[{shape: block, min: [0, 0, 0], max: [1, 1, 1], radius: 1}]",
     "bodies[0].radius: belongs to shape sphere, cylinder, this body is a block"},
    {"[{shape: block, min: [0, 0, 0], max: [1, 1, 1], velocty: [0, 0, 0]}]",
     "bodies[0].velocty: unknown key, did you mean bodies[0].velocity?"},
    {"[{shape: block, min: [0, 0, 0], max: [1, 0, 1]}]",
     "bodies[0].max: y is 0, not above bodies[0].min (0): the box is empty"},
    {"[{shape: block, min: [0, 0, 0.5], max: [1, 1, 0.2]}]", "the box is inverted"},
    {"[{shape: block, min: [0, 0, 0], max: [1, 1, 1]}, {shape: block, min: [0, 0, 0], max: [1, 2, "
     "1]}]",
     "bodies[1].max: reaches y = 2, outside the domain (y from 0 to 1 m)"},
    {"[{shape: sphere, center: [0.5, 0.5, 0.9], radius: 0.2}]", "bodies[0]: reaches z = 1.1"},
    {"[{shape: sphere, center: [0.5, 0.5, 0.5], radius: 0}]",
     "bodies[0].radius: \"0\" is out of range"},
    {"[{shape: random_box, min: [0, 0, 0], max: [1, 1, 1], count: 0}]",
     "count: \"0\" is out of range"},
    {"[{shape: random_box, min: [0, 0, 0], max: [1, 1, 1], count: 3e9}]", "is out of range"},
    {"[{shape: random_box, min: [0, 0, 0], max: [1, 1, 1], count: 9, seed: -1}]",
     "is out of range"},
    {"[{shape: random_box, min: [0, 0, 0], max: [1, 1, 1], count: 2e9}, {shape: random_box, min: "
     "[0, "
     "0, 0], max: [1, 1, 1], count: 1e9}]",
     "bodies: the scene would have 3000000000 particles, at most 2147483647"},
    {"[{shape: block, min: [0, 0, 0], max: [1, 1, 0.05]}]", "bodies[0]: makes no particle"},
};

/// Whole texts.
const std::vector<Case> kTexts{
    {"", "scene.yaml: is empty"},
    {"# only a comment\n", "scene.yaml: is empty"},
    {"---\n", "is empty"},
    {"42\n", "expected a scene: keys such as domain, fluid, bodies; got \"42\""},
    {"- a\n", "expected a scene"},
    {std::string("domain: \0x\n", 11),
     "scene.yaml:1:9: is not plain text: the control character U+0000; remove it; expected a "
     "scene"},
    {"name: \xff\xfe\n", "scene.yaml:1:7: is not plain text: the byte 0xff is not UTF-8; save"},
    {"name: caf\xc3", "scene.yaml:1:10: is not plain text: the byte 0xc3 is not UTF-8"},
    {std::string(5u << 20, '#'), "is larger than 4 MiB"},
    {std::string(100000, '['), "nested deeper than 32 levels"},
    {std::string(100000, '{'), "nested deeper than 32 levels"},
    {"a: &a [x]\nb: &b [*a, *a]\nc: [*b, *b]\n", "anchors (&name) are not supported"},
    {"name: x\n", "scene.yaml:1:1: time.step: missing; required, in s"},
    {"name: x\n", "scene.yaml:1:1: bodies: missing"},
    {"domain: {max: [1, 1, 1]}\n", "scene.yaml:1:9: domain.min: missing; required, in m"},
};

void expect(const std::string& text, const std::string& message) {
  const std::string error = parse_error(text);
  CAPTURE(text.substr(0, 500), message, error);
  CHECK(contains(error, message));
  CHECK(error.rfind("2 scene.yaml", 0) == 0);  // exit code and file, always
}

}  // namespace

TEST_CASE("scene: every malformed entry is refused with its place and remedy") {
  for (const Case& c : kAppended) expect(kMinimal + c.text, c.message);
}

TEST_CASE("scene: every malformed body is refused with its index") {
  for (const Case& c : kBodies) expect(with_bodies(c.text), c.message);
}

TEST_CASE("scene: texts that are no scene are refused") {
  for (const Case& c : kTexts) expect(c.text, c.message);
}

TEST_CASE("scene: a shortest step above time.step, or a millionth of it, is refused") {
  const auto with = [](const std::string& step_min) {
    return "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
           "bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}]\n"
           "time: {step: 0.01, end: 1, adaptive: {step_min: " +
           step_min + "}}\n";
  };
  expect(with("0.02"), "time.adaptive.step_min: is 0.02, above time.step (0.01 s); lower it");
  expect(with("9e-9"), "is 9.0e-09, less than time.step/1048576 (");
  expect(with("0"), "time.adaptive.step_min: \"0\" is out of range, allowed: > 0");
  CHECK(parse(with("0.01")).time.adaptive->step_min == 0.01);
}

TEST_CASE("scene: all problems of a file are reported at once, one per line") {
  const std::string error = parse_error(
      kMinimal + "solver: {iteratons: 4, kernels: x}\ngravity: [1]\nthreads: -1\n", {"name="});
  CHECK(std::count(error.begin(), error.end(), '\n') == 4);
  for (const char* part :
       {"solver.iteratons", "solver.kernels", "gravity", "threads", "--set name="})
    CHECK(contains(error, part));
}

TEST_CASE("scene: thousands of problems do not fill the terminal") {
  std::string text = kMinimal;
  for (int i = 0; i < 5000; ++i) text += "unknown_" + std::to_string(i) + ": 1\n";
  const std::string error = parse_error(text);
  CHECK(contains(error, "... and 4900 more problems"));
  CHECK(std::count(error.begin(), error.end(), '\n') == 100);
}

TEST_CASE("scene: numbers are decimal, whatever YAML 1.1 says") {
  CHECK(parse(kMinimal + "measure_every: 010\n").measure_every == 10);
  CHECK(parse(kMinimal + "measure_every: 1e3\n").measure_every == 1000);
  CHECK(parse(kMinimal + "measure_every: +7\n").measure_every == 7);
  CHECK(parse(kMinimal + "measure_every: 4.0\n").measure_every == 4);
  CHECK(parse(kMinimal + "gravity: [.5, -1., +2e-1]\n").gravity == Double3{0.5, -1, 0.2});
  CHECK(parse(kMinimal + "name: 010\n").name == "010");
}

TEST_CASE("scene: Windows line ends and a byte order mark are tolerated") {
  std::string text = "\xEF\xBB\xBF";
  for (char c : kMinimal) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(parse(text) == parse(kMinimal));
}

TEST_CASE("scene: no mutilated scene does anything but parse or raise a bad-input error") {
  const std::string whole = reference_yaml();
  std::mt19937 random(7);  // the engine's numbers are fixed by the standard
  int refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string text = whole;
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random() % 128);
          break;
        case 1:
          text.erase(at, random() % 30);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 40));
          break;
        default:
          text.insert(at, 1, "[]{}:,&*!|>'\"%@-\t\n"[random() % 18]);
      }
    }
    const std::string error = parse_error(text);
    if (error == "no error") continue;
    ++refused;
    CAPTURE(trial, error);
    CHECK(error.rfind("2 scene.yaml", 0) == 0);
  }
  CHECK(refused > 50);
}

TEST_CASE("scene: every key of the table can be misspelt and is found again") {
  for (const Key& key : scene_table().keys) {
    if (key.leaf().size() < 5) continue;
    // A plural beside its singular: the misspelt word is nearer to that.
    if (scene_table().find_key(key.path.substr(0, key.path.size() - 1))) continue;
    std::string wrong = key.path;
    std::swap(wrong[wrong.size() - 1], wrong[wrong.size() - 2]);
    CAPTURE(wrong);
    CHECK(suggest_key(scene_table(), wrong).keys == std::vector<std::string>{key.path});
  }
}

}  // namespace pbf::scene_test
