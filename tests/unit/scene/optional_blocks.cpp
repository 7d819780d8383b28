// Optional blocks with required keys, and texts that may be empty: a table of its own, of structs
// that the program knows nothing of.
#include <nlohmann/json.hpp>

#include "lib/scene/difference.h"
#include "lib/scene/key_rows.h"
#include "lib/scene/overrides.h"
#include "lib/scene/validate.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

struct Filter {
  double width = 0.25;
};
struct Probe {
  double radius = 0.5, gain = 2;
  std::string label = "probe", path;
  std::optional<Filter> filter;
};
struct Rig {
  double length = 1;
  std::string note;
  std::string owner = "nobody";
  std::optional<Probe> probe;
};

const KeyTable& rig_table() {
  static Rig defaults;
  static const KeyTable table(
      {{{{"", "A rig."},
         optional_block(MEMBER(Rig, probe), "Probe."),
         optional_block(MEMBER(Rig, probe->filter), "Filter.")},
        {key(MEMBER(Rig, length), number("m", {0, 9}), "Length."),
         key(MEMBER(Rig, note), scene_module::plain, "Note."),
         key(MEMBER(Rig, owner), scene_module::plain, "Owner."),
         key(MEMBER(Rig, probe->radius), number("m", {0, 9, true}), "Radius.", required),
         key(MEMBER(Rig, probe->gain), number("", {0, 9}), "Gain."),
         key(MEMBER(Rig, probe->label), scene_module::plain, "Label.", required),
         key(MEMBER(Rig, probe->path), scene_module::plain, "File."),
         key(MEMBER(Rig, probe->filter->width), number("m", {0, 9}), "Width.", required)}}},
      object(defaults));
  return table;
}

struct Lamp {
  double power = 3;
};
struct Lit {
  std::optional<Lamp> lamp = Lamp{};
};

const KeyTable& lit_table() {
  static Lit defaults;
  static const KeyTable table(
      {{{{"", "A room."}, optional_block(MEMBER(Lit, lamp), "Lamp.", on_by_default)},
        {key(MEMBER(Lit, lamp->power), number("W", {0, 9}), "Power.", required)}}},
      object(defaults));
  return table;
}

Rig rig(const std::string& text, const std::vector<std::string>& settings = {}) {
  return read_struct<Rig>(rig_table(), text, "rig.yaml", settings);
}
std::string rig_error(const std::string& text, const std::vector<std::string>& settings = {}) {
  return error_of([&] { rig(text, settings); });
}
std::string yaml(const Rig& r, bool comments = false) {
  return yaml_of(rig_table(), object(r), comments);
}

}  // namespace

TEST_CASE("an optional block that is absent or off needs none of its required keys") {
  for (const char* text : {"length: 2\n", "{length: 2, probe: off}\n"}) {
    CHECK_FALSE(rig(text).probe);
    CHECK(rig(text).length == 2);
  }
  const Rig r = rig("probe: {radius: 1, label: a}\n");
  REQUIRE(r.probe);
  CHECK(r.probe->radius == 1);
  CHECK(r.probe->gain == 2);
  CHECK_FALSE(r.probe->filter);
  CHECK_FALSE(rig("probe: {gain: 1}\n", {"probe=off"}).probe);
}

TEST_CASE("an optional block that is given in any way must have its required keys") {
  const std::string radius = "probe.radius: missing; required, in m (Radius.)",
                    label = "probe.label: missing; required (Label.)";
  CHECK(rig_error("probe: {gain: 3, label: a}\n") == "2 rig.yaml:1:8: " + radius);
  for (const char* text : {"probe: {}\n", "probe: on\n", "probe: {gain: 3}\n"}) {
    CAPTURE(text);
    CHECK(rig_error(text) == "2 rig.yaml:1:8: " + radius + "\nrig.yaml:1:8: " + label);
  }
  CHECK(contains(rig_error("length: 2\n", {"probe=on"}), "--set probe=on: " + radius));
  CHECK(contains(rig_error("length: 2\n", {"probe.label=a"}), radius));
  CHECK(rig("length: 2\n", {"probe.label=a", "probe.radius=4"}).probe->radius == 4);
  // A block within, optional too: needed where it is given.
  for (const char* filter : {"{}", "on"})
    CHECK(rig_error("probe: {radius: 1, label: a, filter: " + std::string(filter) + "}\n") ==
          "2 rig.yaml:1:38: probe.filter.width: missing; required, in m (Width.)");
  CHECK(rig("probe: {radius: 1, label: a, filter: {width: 3}}\n").probe->filter->width == 3);
  CHECK(contains(rig_error("probe: 3\n"),
                 "probe: expected a block {radius: ...}, got \"3\"; write off "));
}

TEST_CASE("a block that is on by default and has a required key must be given or turned off") {
  const auto lit = [](const char* text) {
    return read_struct<Lit>(lit_table(), text, "lit.yaml", {});
  };
  CHECK(error_of([&] { lit("{}\n"); }) ==
        "2 lit.yaml:1:1: lamp.power: missing; required, in W (Power.)");
  CHECK(lit("lamp: {power: 4}\n").lamp->power == 4);
  CHECK_FALSE(lit("lamp: off\n").lamp);
  Lit room;
  CHECK(contains(yaml_of(lit_table(), object(room), true),
                 "# Lamp. Optional: off with `lamp: off`.\nlamp:\n"));
}

TEST_CASE("the reference of optional blocks with required keys is valid, and names them") {
  Rig all;
  rig_table().make_all_present(object(all));
  const std::string text = yaml(all, true);
  CHECK(text ==
        "# Length. [unit m; 0 .. 9; default 1]\n"
        "length: 1\n"
        "# Note. [text; default \"\"]\n"
        "note: \"\"\n"
        "# Owner. [text; default nobody]\n"
        "owner: nobody\n"
        "\n"
        "# Probe. Optional: without this block, or with `probe: off`, it is off.\n"
        "probe:\n"
        "  # Radius. [unit m; > 0 .. 9; required]\n"
        "  radius: 0.5\n"
        "  # Gain. [unit 1; 0 .. 9; default 2]\n"
        "  gain: 2\n"
        "  # Label. [text; required]\n"
        "  label: probe\n"
        "  # File. [text; default \"\"]\n"
        "  path: \"\"\n"
        "\n"
        "  # Filter. Optional: without this block, or with `filter: off`, it is off.\n"
        "  filter:\n"
        "    # Width. [unit m; 0 .. 9; required]\n"
        "    width: 0.25\n");
  CHECK(yaml(rig(text)) == yaml(all));
}

TEST_CASE("a block that is off says nothing of the optional blocks in it") {
  CHECK(yaml(Rig{}) == "length: 1\nnote: \"\"\nowner: nobody\nprobe: off\n");
  CHECK(yaml(rig(yaml(Rig{}))) == yaml(Rig{}));
  const auto difference = [](const Rig& a, const Rig& b) {
    return first_of(differences(rig_table(), object(a), object(b), Effect::results));
  };
  const Rig bare = rig("probe: {radius: 1, label: a}\n");
  const Rig whole = rig("probe: {radius: 1, label: a, filter: {width: 3}}\n");
  CHECK(difference({}, {}).empty());
  CHECK(difference(whole, {}) == "probe: on before, off now");
  CHECK(difference(bare, whole) == "probe.filter: off before, on now");
}

TEST_CASE("the schema asks for required keys of optional blocks where these are given") {
  const auto schema = nlohmann::json::parse(schema_of(rig_table()));
  CHECK_FALSE(schema.contains("required"));
  const auto probe = schema["properties"]["probe"]["anyOf"];
  CHECK(probe[0]["required"] == nlohmann::json::array({"radius", "label"}));
  CHECK(probe[1]["enum"] == nlohmann::json::array({"off", false}));
  CHECK(nlohmann::json::parse(schema_of(lit_table()))["required"] ==
        nlohmann::json::array({"lamp"}));
}

TEST_CASE("a text is empty only where its default is and none is required") {
  const std::string probe = "probe: {radius: 1, label: a, path: x.csv}\nnote: some\n";
  CHECK(rig(probe).probe->path == "x.csv");
  for (const Rig& r : {rig(probe, {"probe.path=\"\"", "note=''"}),
                       rig("probe: {radius: 1, label: a, path: \"\"}\nnote: ''\n")}) {
    CHECK(r.probe->path.empty());
    CHECK(r.note.empty());
    CHECK(contains(yaml(r), "note: \"\"\n"));
    CHECK(contains(yaml(r), "  path: \"\"\n"));
    CHECK(yaml(rig(yaml(r))) == yaml(r));
  }
  CHECK(rig_error("owner: \"\"\n") == "2 rig.yaml:1:8: owner: is empty, expected text");
  CHECK(rig_error("probe: {radius: 1, label: \"\"}\n") ==
        "2 rig.yaml:1:27: probe.label: is empty, expected text");
  CHECK(rig_error(probe, {"probe.label=\"\""}) ==
        "2 --set probe.label=\"\": probe.label: is empty, expected text");
  // Nothing at all is a value forgotten.
  CHECK(contains(rig_error("note:\n"), "note: has no value"));
  CHECK(contains(rig_error(probe, {"note="}), "note: has no value"));
  const auto schema = nlohmann::json::parse(schema_of(rig_table()))["properties"];
  CHECK(schema["note"]["minLength"] == 0);
  CHECK(schema["note"]["default"] == "");
  CHECK(schema["owner"]["minLength"] == 1);
}

}  // namespace pbf::scene_test
