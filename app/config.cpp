// pbf config: the scene format, as an example with every key or as a JSON Schema; the stages.
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/json.h"
#include "lib/base/log.h"
#include "lib/base/stages.h"
#include "lib/scene/load.h"

namespace pbf::app_module {

namespace {

struct ConfigOptions {
  bool schema = false, example = false, markdown = false, stages = false;
};

std::string stages_json() {
  Json out;
  for (const StageGroupInfo& g : kStageGroups)
    out["groups"].push_back({{"name", g.name}, {"color", g.color}});
  for (const Stage& s : kStages)
    out["stages"].push_back({{"name", s.name},
                             {"group", kStageGroups[static_cast<int>(s.group)].name},
                             {"color", s.color}});
  return json_text(out, 1);
}

int command_config(const ConfigOptions& options) {
  if (!options.schema && !options.example && !options.markdown && !options.stages) {
    Log(false).result(
        "A scene is a YAML file; pbf config prints all that one may hold, at once:\n"
        "  pbf config --example   the reference scene: every key with unit, range, default, "
        "meaning\n"
        "  pbf config --markdown  the same as a page of tables\n"
        "  pbf config --schema    a JSON Schema, with which editors complete and check scenes\n"
        "  pbf config --stages    the stages of a run with their groups and colors in plots\n"
        "The smallest scene that runs is configs/minimal.yaml.");
    return 0;
  }
  std::string text = options.schema     ? json_schema()
                     : options.markdown ? reference_markdown()
                     : options.stages   ? stages_json()
                                        : reference_yaml();
  if (!text.empty() && text.back() == '\n') text.pop_back();  // result() adds the line break
  Log(false).result(text);
  return 0;
}

}  // namespace

void add_config(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_config, "config", "The scene format",
                                  "Example:\n  pbf config --example > my_scene.yaml");
  CLI::Option_group* one = c->add_option_group("what");
  one->add_flag("--example", o.example, "The reference scene: every key, default, unit, meaning");
  one->add_flag("--markdown", o.markdown, "The same as a page with a table for each block");
  one->add_flag("--schema", o.schema, "JSON Schema of a scene file, for editors");
  one->add_flag("--stages", o.stages, "The stages of a run as JSON, with groups and colors");
  one->require_option(0, 1);
}

}  // namespace pbf::app_module
