// pbf plan: what a scene would do and need; runs nothing.
#include "lib/program/plan.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/json.h"
#include "lib/base/log.h"
#include "lib/base/machine.h"
#include "lib/base/text.h"
#include "lib/campaign/calibration.h"
#include "lib/program/threads.h"
#include "lib/run/emit.h"
#include "lib/run/load_run.h"
#include "lib/run/start_neighbors.h"
#include "lib/run/warnings.h"

namespace pbf::inline app_module {
namespace {

struct PlanOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::string base_folder;
  bool resolved = false, json = false;
};

const char* const kPlanHelp =
    "The time per update is an estimate from what `pbf bench --calibrate` has stored on this\n"
    "machine; without it none is printed.\n"
    "Example:\n  pbf plan configs/dam_break.yaml --set fluid.spacing=0.005";

std::string time_text(const std::optional<TimeEstimate>& time) {
  if (!time)
    return "time per update\n  not known: nothing is stored for this backend, precision, CPU and "
           "number of threads; pbf bench --calibrate measures it";
  return format("time per update\n  about %.4g ms, from pbf bench --calibrate on %s", time->ms,
                time->basis.c_str());
}

std::string warnings_text(const std::vector<Warning>& warnings) {
  std::string text = "\nwarnings\n";
  for (const Warning& w : warnings) text += "  " + w.text + "\n";
  return warnings.empty() ? std::string() : text;
}

std::string json(const Plan& plan, const Scene& scene, const std::optional<TimeEstimate>& time,
                 const std::vector<Warning>& warnings) {
  Json out = plan_json(plan, scene);
  out["time_per_update_ms"] = nullptr;
  if (time) {
    out["time_per_update_ms"] = time->ms;
    out["time_measured_on"] = time->basis;
  }
  Json& list = out["warnings"] = Json::array();
  for (const Warning& w : warnings) list.push_back({{"kind", w.kind}, {"text", w.text}});
  return json_text(out);
}

int command_plan(const PlanOptions& options) {
  const LoadedScene loaded =
      load_scene_or_run(options.scene, options.overrides, options.base_folder);
  Log log(false);
  const std::string& dir = loaded.folder;
  // Counted for --resolved too: a scene that cannot run is an error in every form of the answer.
  const std::int64_t n = count_particles(loaded.scene, dir);
  const Plan plan = make_plan(loaded.scene, n, start_neighbors(loaded.scene, dir, n));
  const int threads = solver_threads(loaded.scene, plan.particles);
  const std::vector<StageCosts> costs = read_calibration(calibration_path());
  const auto time = estimate_time(plan, loaded.scene, costs, threads, cpu_model());
  const std::vector<Warning> warnings = scene_warnings(loaded.scene, dir, n);
  std::string text =
      options.resolved ? resolved_yaml(loaded.scene)
      : options.json   ? json(plan, loaded.scene, time, warnings)
                       : plan_text(plan, loaded.scene) + time_text(time) + warnings_text(warnings);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  log.result(text);
  return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& code) {
  const auto [c, o] = add_command(
      app, code, command_plan, "plan",
      "Passes, arrays, memory and files of a scene, and what is left out; runs nothing", kPlanHelp);
  c->add_option("SCENE", o.scene, "Scene file (YAML), or a run file for its scene")->required();
  add_overrides(c, o.overrides);
  add_base_folder(c, o.base_folder);
  CLI::Option* resolved =
      c->add_flag("--resolved", o.resolved, "Print the scene with every default filled in");
  c->add_flag("--json", o.json, "Print the plan as one JSON object")->excludes(resolved);
}

}  // namespace pbf::inline app_module
