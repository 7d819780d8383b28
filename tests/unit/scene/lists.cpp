// Lists of structs are rows of the table of keys. A table of its own, of structs that the program
// knows nothing of, with two lists: one must have entries and has kinds, one may be empty.
#include "lib/scene/difference.h"
#include "lib/scene/key_rows.h"
#include "lib/scene/overrides.h"
#include "lib/scene/validate.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

enum class Form { disc, pipe };
struct Gate {
  Form form = Form::disc;
  double radius = 0, length = 2;
  std::string label = "none";
};
struct Gauge {
  Double3 at{};
  int every = 3;
};
struct Tank {
  double depth = 1;
  std::vector<Gate> gates;
  std::vector<Gauge> gauges;
};

const KeyTable& tank_table() {
  static Tank defaults;
  static const KeyTable table(
      {{{{"", "A tank."},
         list_block(MEMBER(Tank, gates), "Gates of the tank",
                    {.entry_name = "gate",
                     .least = 2,
                     .remark = "in the order of the flow",
                     .example = "{form: disc, radius: 1}",
                     .further = "{form: pipe, radius: 1, length: 2}"}),
         list_block(MEMBER(Tank, gauges), "Gauges",
                    {.entry_name = "gauge", .example = "{at: [0, 0, 0]}"}, effect(Effect::none))},
        {key(MEMBER(Tank, depth), number("m", {0, 9}), "Depth."),
         key(MEMBER_OF(gates, Gate, form), one_of({"disc", "pipe"}), "Form.", required, is_kind),
         key(MEMBER_OF(gates, Gate, radius), number("m", {0, 9, true}), "Radius.", required),
         key(MEMBER_OF(gates, Gate, length), number("m", {0, 9}), "Length.", of(Form::pipe)),
         key(MEMBER_OF(gates, Gate, label), scene_module::plain, "Label.", renamed("gates[].name"),
             effect(Effect::none)),
         key(MEMBER_OF(gauges, Gauge, at), number("m", {-9, 9}), "Where.", required),
         key(MEMBER_OF(gauges, Gauge, every), number("", {1, 99}), "How often.")}}},
      object(defaults));
  return table;
}

Tank read(const std::string& text, const std::vector<std::string>& settings = {}) {
  return read_struct<Tank>(tank_table(), text, "tank.yaml", settings);
}
std::string error(const std::string& text, const std::vector<std::string>& settings = {}) {
  return error_of([&] { read(text, settings); });
}
std::string yaml(const Tank& tank, bool comments = false) {
  return yaml_of(tank_table(), object(tank), comments);
}
std::string difference(const Tank& a, const Tank& b, Effect least = Effect::results) {
  return first_of(differences(tank_table(), object(a), object(b), least));
}

const std::string kGates =
    "gates:\n"
    "  - {form: disc, radius: 1}\n"
    "  - {form: pipe, radius: 0.5, length: 3, label: drain}\n";
const std::string kTank = kGates + "gauges: [{at: [1, 2, 3]}, {at: [0, 0, 1], every: 7}]\n";

}  // namespace

TEST_CASE(
    "lists as rows: entries are read with their defaults, a list without a least is optional") {
  const Tank tank = read(kTank);
  REQUIRE(tank.gates.size() == 2);
  CHECK(tank.gates[0].form == Form::disc);
  CHECK(tank.gates[0].length == 2);
  CHECK(tank.gates[1].form == Form::pipe);
  CHECK(tank.gates[1].length == 3);
  CHECK(tank.gates[1].label == "drain");
  REQUIRE(tank.gauges.size() == 2);
  CHECK(tank.gauges[0].at == Double3{1, 2, 3});
  CHECK(tank.gauges[0].every == 3);
  CHECK(tank.gauges[1].every == 7);
  CHECK(read(kGates).gauges.empty());
  CHECK(read(kGates + "gauges: []\n").gauges.empty());
}

TEST_CASE("lists as rows: --set reaches into the entries of each, with the same checks") {
  const Tank tank = read(kTank, {"gates[1].label=weir", "gauges.0.every=9", "gates.0.radius=2"});
  CHECK(tank.gates[1].label == "weir");
  CHECK(tank.gauges[0].every == 9);
  CHECK(tank.gates[0].radius == 2);
  CHECK(read(kTank, {"gauges=[]"}).gauges.empty());
  CHECK(
      error(kTank, {"gauges[2].every=9"}) ==
      "2 --set gauges[2].every=9: gauges[2].every: gauges is a list of 2, \"2\" is no index of it "
      "(the first is 0)");
  CHECK(error(kTank, {"gauges[1].every=0"}) ==
        "2 --set gauges[1].every=0: gauges[1].every: \"0\" is out of range, allowed: 1 .. 99");
}

TEST_CASE("lists as rows: what is wrong names file, line, entry and remedy") {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"gauges: []\n", "tank.yaml:1:1: gates: missing; required, a list of at least 2 gates"},
      {"gates: [{form: disc, radius: 1}]\n",
       "tank.yaml:1:8: gates: expected a list of at least 2 gates, e.g. - {form: disc, radius: 1}; "
       "got a list of 1"},
      {kGates + "gauges: 3\n",
       "tank.yaml:4:9: gauges: expected a list of gauges, e.g. - {at: [0, 0, 0]}; got \"3\""},
      {kGates + "gauges: off\n", "tank.yaml:4:9: gauges: expected a list of gauges"},
      {kGates + "gauges:\n  - 3\n",
       "tank.yaml:5:5: gauges[0]: expected a gauge such as {at: [0, 0, 0]}, got \"3\""},
      {kGates + "gauges: [{every: 4}]\n",
       "tank.yaml:4:10: gauges[0].at: missing; required, in m (Where.)"},
      {"gates: [{form: disc, radius: 1, length: 2}, {form: pipe, radius: 1}]\n",
       "tank.yaml:1:33: gates[0].length: belongs to form pipe, this gate is a disc; remove it or "
       "change the form"},
      {"gates: [{radius: 1, length: 2}, {form: pipe, radius: 1}]\n",
       "tank.yaml:1:9: gates[0].form: missing; required: disc | pipe (Form.)"},
      {"gates: [{form: pip, radius: 1, length: 2}, {form: pipe, radius: 1}]\n",
       "gates[0].form: \"pip\" is not one of disc, pipe; did you mean pipe?"},
      {"gates: [{form: disc, radius: 1}, {form: pipe, radius: 1, name: x}]\n",
       "tank.yaml:1:58: gates[1].name: is called gates[].label now; rename it"},
      {kTank + "gauges: []\n", "gauges: given twice, first at tank.yaml:4:1; remove one"},
      {kTank + "gauges[]: 3\n", "gauges[]: unknown key, did you mean gauges?"},
      {kTank + "gauges[].every: 3\n",
       "tank.yaml:5:1: gauges[].every: belongs into an entry of gauges; write it there"},
  };
  for (const auto& [text, expected] : cases) {
    CAPTURE(text);
    CAPTURE(expected, error(text));
    CHECK(contains(error(text), expected));
  }
}

TEST_CASE("lists as rows: a misspelt key is found in its own list alone") {
  const auto near = [](const std::string& gate, const std::string& gauge) {
    return error("gates: [{form: disc, radius: 1}, {form: pipe, radius: 1" + gate +
                 "}]\ngauges: [{at: [0, 0, 0]" + gauge + "}]\n");
  };
  CHECK(contains(near(", lenght: 1", ""),
                 "gates[1].lenght: unknown key, did you mean "
                 "gates[1].length?"));
  CHECK(contains(near("", ", evrey: 1"),
                 "gauges[0].evrey: unknown key, did you mean "
                 "gauges[0].every?"));
  // An entry of the other list has such a key, but this one cannot take it.
  CHECK(contains(near("", ", radius: 1"), "gauges[0].radius: unknown key"));
  CHECK_FALSE(contains(near("", ", radius: 1"), "did you mean"));
  CHECK(contains(error(kGates + "gauge: []\n"), "gauge: unknown key, did you mean gauges?"));
}

TEST_CASE("lists as rows: keys of entries that were renamed are read from what is stored") {
  Node earlier = parse_yaml(
      "gates: [{form: disc, radius: 1}, {form: pipe, radius: 0.5, length: 3, name: drain}]\n",
      "tank.yaml", true);
  use_new_names(tank_table(), earlier);
  Tank tank;
  Problems problems;
  read_tree(tank_table(), earlier, object(tank), problems);
  CHECK(problems.empty());
  CHECK(yaml(tank) == yaml(read(kGates)));
}

TEST_CASE("lists as rows: what is written is read back, an empty list too") {
  const std::string text =
      "depth: 1\n"
      "gates:\n"
      "  - {form: disc, radius: 1, label: none}\n"
      "  - {form: pipe, radius: 0.5, length: 3, label: drain}\n";
  CHECK(yaml(read(kGates)) == text + "gauges: []\n");
  CHECK(yaml(read(kTank)) == text +
                                 "gauges:\n"
                                 "  - {at: [1, 2, 3], every: 3}\n"
                                 "  - {at: [0, 0, 1], every: 7}\n");
  for (const std::string& tank : {kTank, kGates})
    CHECK(yaml(read(yaml(read(tank)))) == yaml(read(tank)));
}

TEST_CASE("lists as rows: the reference says which kinds have a key, and shows a further entry") {
  CHECK(yaml(read(kGates), true) ==
        "# Depth. [unit m; 0 .. 9; default 1]\n"
        "depth: 1\n"
        "\n"
        "# Gates of the tank, at least 2; in the order of the flow.\n"
        "# form: Form. [disc | pipe; required]\n"
        "# radius: Radius. [of disc, pipe; unit m; > 0 .. 9; required]\n"
        "# length: Length. [of pipe; unit m; 0 .. 9; default 2]\n"
        "# label: Label. [of disc, pipe; text; default none]\n"
        "gates:\n"
        "  - {form: disc, radius: 1, label: none}\n"
        "  - {form: pipe, radius: 0.5, length: 3, label: drain}\n"
        "  # - {form: pipe, radius: 1, length: 2}\n"
        "\n"
        "# Gauges.\n"
        "# at: Where. [unit m; -9 .. 9; required]\n"
        "# every: How often. [unit 1; 1 .. 99; default 3]\n"
        "gauges: []\n");
}

TEST_CASE("lists as rows: the schema has each, by kind where there are kinds") {
  const std::string text = schema_of(tank_table());
  CHECK(contains(text, "\"required\":[\"gates\"]"));
  CHECK(contains(text,
                 "\"gates\":{\"description\":\"Gates of the tank.\",\"type\":\"array\","
                 "\"minItems\":2,\"items\":{\"oneOf\":["));
  CHECK(contains(text, "\"form\":{\"const\":\"disc\"}"));
  CHECK(contains(text, "\"form\":{\"const\":\"pipe\"}"));
  CHECK(contains(text,
                 "\"gauges\":{\"description\":\"Gauges.\",\"type\":\"array\",\"minItems\":0,"
                 "\"items\":{\"type\":\"object\""));
  std::size_t lengths = 0;
  for (std::size_t p = 0; (p = text.find("\"length\":{", p)) != std::string::npos; ++p) ++lengths;
  CHECK(lengths == 1);
}

TEST_CASE("lists as rows: two structs differ in the number of entries or in a key of one") {
  const Tank tank = read(kTank);
  CHECK(difference(tank, tank).empty());
  CHECK(difference(tank, read(kTank, {"gates[1].length=4"})) == "gates[1].length: 3 before, 4 now");
  CHECK(difference(tank, read(kTank, {"gates[0].form=pipe"})) ==
        "gates[0].form: disc before, pipe now");
  CHECK(difference(read("gates: [{form: disc, radius: 1}, {form: disc, radius: 1}, "
                        "{form: disc, radius: 1}]\n"),
                   tank) == "gates: 3 before, 2 now");
  CHECK(difference(tank, read(kTank, {"gates[0].radius=2", "gates[1].length=4"})) ==
        "gates[0].radius: 1 before, 2 now; gates[1].length: 3 before, 4 now");
  // Keys and lists that leave the results alone are not looked at, unless asked for.
  CHECK(difference(tank, read(kTank, {"gates[0].label=x", "gauges=[]"})).empty());
  CHECK(difference(tank, read(kTank, {"gates[0].label=x"}), Effect::none) ==
        "gates[0].label: none before, x now");
  CHECK(difference(tank, read(kTank, {"gauges=[]"}), Effect::none) == "gauges: 2 before, 0 now");
}

}  // namespace pbf::scene_test
