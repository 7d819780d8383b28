// pbf plan: what a scene would do and need; runs nothing.
#include "lib/plan/plan.h"

#include <filesystem>

#include "app/commands.h"
#include "lib/base/log.h"
#include "lib/scene/emit.h"
#include "lib/scene/load.h"

namespace pbf {

int command_plan(const PlanOptions& options) {
  const LoadedScene loaded = load_scene(options.scene, options.overrides);
  Log log(false);
  const std::string dir = std::filesystem::path(loaded.path).parent_path().string();
  // Counted for --resolved too: a scene that cannot run is an error in every form of the answer.
  const Plan plan = make_plan(loaded.scene, count_particles(loaded.scene, dir));
  std::string text = options.resolved ? resolved_yaml(loaded.scene)
                     : options.json   ? plan_json(plan, loaded.scene)
                                      : plan_text(plan, loaded.scene);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  log.result(text);
  return 0;
}

}  // namespace pbf
