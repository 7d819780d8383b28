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
#include "lib/program/rank_plan.h"
#include "lib/program/threads.h"
#include "lib/run/load_run.h"
#include "lib/run/start.h"

namespace pbf::app_module {
namespace {

struct PlanOptions : SceneOptions {
  std::string scene;
  int threads = 0;  ///< 0: as the scene says
  int ranks = 1;
  bool resolved = false, json = false, arrays = false;
};

const char* const kPlanHelp =
    "The first five lines are the answer: particles; time and updates; run time; peak memory, "
    "with\n"
    "program and libraries; size of all files. Then come warnings, files, memory on every "
    "backend,\n"
    "the passes of an update, and what is left out.\n"
    "The run time is that of the updates, from what `pbf bench --calibrate` has stored on this\n"
    "machine; without it, on the CPU, a rule of thumb.\n"
    "Example:\n  pbf plan configs/dam_break.yaml --set fluid.spacing=0.005";

std::string run_time_text(const std::optional<RunTime>& time) {
  return time ? time->text()
              : "not known; pbf bench --calibrate --backend cuda measures this machine";
}

std::string warnings_text(const std::vector<Warning>& warnings) {
  std::string text = "warnings\n";
  for (const Warning& w : warnings) text += "  " + w.text + "\n";
  return warnings.empty() ? std::string() : text;
}

std::string json(const Plan& plan, const Scene& scene, const std::optional<TimeEstimate>& update,
                 const std::optional<RunTime>& all, const std::vector<Warning>& warnings,
                 int ranks) {
  Json out = plan_json(plan, scene);
  out["run_time_s"] = nullptr;
  if (all) {
    out["run_time_s"] = all->seconds;
    out["run_time_is_rough"] = all->rough;
    out["run_time_basis"] = all->basis;
  }
  out["time_per_update_ms"] = nullptr;
  if (update) {
    out["time_per_update_ms"] = update->ms;
    out["time_measured_on"] = update->basis;
  }
  Json& list = out["warnings"] = Json::array();
  for (const Warning& w : warnings) list.push_back({{"kind", w.kind}, {"text", w.text}});
  if (ranks > 1) out["ranks"] = rank_json(plan_ranks(plan, scene, ranks));
  return json_text(out);
}

int command_plan(const PlanOptions& options) {
  Log log(false);
  // Plan for --resolved too: a scene that cannot run is an error in every form of output.
  std::vector<std::string> overrides = options.overrides;
  if (options.threads > 0) overrides.push_back("threads=" + std::to_string(options.threads));
  const Start start = prepare(load_scene_or_run(options.scene, overrides, options.base_folder),
                              {.fits = false,
                               .warnings = true,
                               .particles = false,
                               .measured = true,
                               .progress = [&](const std::string& t) { log.progress(t); }});
  const Plan& plan = start.plan;
  const Scene& scene = start.scene();
  const int threads = solver_threads(scene, plan.particles);
  const std::vector<StageCosts> costs = read_calibration(calibration_path());
  const auto update = estimate_time(plan, scene, costs, threads, cpu_model());
  const auto all = run_time(plan, scene, update, threads);
  std::string text;
  if (options.resolved) {
    text = resolved_yaml(scene);
  } else if (options.json) {
    text = json(plan, scene, update, all, start.warnings, options.ranks);
  } else {
    text = plan_summary(plan, scene, run_time_text(all)) + warnings_text(start.warnings) +
           plan_details(plan, scene);
    if (options.ranks > 1) text += rank_text(plan_ranks(plan, scene, options.ranks));
    text += options.arrays ? plan_arrays(plan, scene)
                           : "--arrays lists every array; --json has it all\n";
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  log.result(text);
  return 0;
}

}  // namespace

void add_plan(CLI::App& app, int& code) {
  const auto [c, o] = add_command(
      app, code, command_plan, "plan",
      "Particles, run time, memory and disk of a scene before it is run; runs nothing", kPlanHelp);
  c->add_option("SCENE", o.scene,
                "Scene file (YAML), or a run for its scene: its run file or its folder")
      ->required();
  c->add_option("--threads", o.threads, "CPU threads of the run, which its memory depends on")
      ->transform(whole_number(1, 4096));
  c->add_option("--ranks", o.ranks,
                "Ranks of the run (mpirun -n): what they send to each other, their memory")
      ->transform(whole_number(1, 65536));
  add_scene_options(c, o);
  CLI::Option* resolved =
      c->add_flag("--resolved", o.resolved, "Print the scene with every default filled in");
  CLI::Option* as_json =
      c->add_flag("--json", o.json, "Print the plan as one JSON object")->excludes(resolved);
  c->add_flag("--arrays", o.arrays, "List every array, and the memory of program and libraries")
      ->excludes(resolved)
      ->excludes(as_json);
}

}  // namespace pbf::app_module
