// The command line of pbf; every error ends here, as one message and an exit code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <limits>
#include <new>
#include <sstream>

#include "app/commands.h"
#include "app/help.h"
#include "app/number_options.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/plain_text.h"
#include "lib/base/version.h"
#include "lib/run/signals.h"

namespace pbf::inline app_module {
namespace {

using Command = std::function<int()>;

/// Of a limit on the wall time.
CLI::Validator seconds_above_0() { return number_from(0, true, "seconds"); }

void add_overrides(CLI::App* c, std::vector<std::string>& overrides) {
  c->add_option("--set", overrides, "Replace one key of the scene, KEY.PATH=VALUE; repeatable")
      ->take_all()
      ->allow_extra_args(false);
}

void add_run(CLI::App& app, RunOptions& o, Command& command) {
  CLI::App* c =
      app.add_subcommand("run", "Simulate a scene: run.vtkhdf and pictures in one folder");
  c->add_option("SCENE", o.scene, "Scene file (YAML), or the run file of a run to repeat")
      ->required();
  c->add_option("--out", o.out, "Run folder; out/<scene name> when not given");
  c->add_option("--backend", o.backend, "Where to run")->check(CLI::IsMember({"cpu", "cuda"}));
  c->add_option("--precision", o.precision, "Of the computation")
      ->check(CLI::IsMember({"float", "double"}));
  c->add_option("--threads", o.threads, "CPU threads")->transform(whole_number(1, 4096));
  add_overrides(c, o.overrides);
  CLI::Option* overwrite =
      c->add_flag("--overwrite", o.overwrite, "Replace the run in an existing folder");
  c->add_flag(
       "--resume", o.resume,
       "Go on from the last checkpoint; leave a finished run as it is and exit 0, or prolong "
       "it to a later time.end; start it when the folder is not there")
      ->excludes(overwrite);
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->add_flag("--strict", o.strict,
              "A warning ends the run with exit 6: before it where the scene gives it, else after "
              "saving");
  c->add_option("--log-json", o.log_json, "One JSON object per line and measure, into this file");
  c->add_option("--max-walltime", o.max_walltime, "Stop after so many seconds, save, exit 75")
      ->transform(seconds_above_0());
  c->footer(std::string(help::kRunHelp) + help::diagnostics_text());
  c->callback([&] { command = [&] { return command_run(o); }; });
}

void add_plan(CLI::App& app, PlanOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand(
      "plan", "Passes, arrays, memory and files of a scene, and what is left out; runs nothing");
  c->add_option("SCENE", o.scene, "Scene file (YAML)")->required();
  add_overrides(c, o.overrides);
  CLI::Option* resolved =
      c->add_flag("--resolved", o.resolved, "Print the scene with every default filled in");
  c->add_flag("--json", o.json, "Print the plan as one JSON object")->excludes(resolved);
  c->footer(help::kPlanHelp);
  c->callback([&] { command = [&] { return command_plan(o); }; });
}

void add_render(CLI::App& app, RenderOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand("render", "Pictures from the frames of a run file");
  c->add_option("RUN", o.run, "Run file (run.vtkhdf)")->required();
  c->add_option("--frames", o.frames, "all, k, a:b or a:b:step; b excluded, negative from the end");
  c->add_option("--size", o.size, "WIDTHxHEIGHT in pixels");
  c->add_option("--camera", o.camera, "position=x,y,z;target=x,y,z;fov=degrees;orbit=degrees/s");
  c->add_option("--color", o.color, "What colours the particles")
      ->check(CLI::IsMember({"speed", "density", "id"}));
  c->add_option("--range", o.range, "LOW,HIGH of the colour bar, in the unit of the field");
  c->add_option("--out", o.out, "Folder of the pictures; render/ beside the run file");
  c->footer(help::kRenderHelp);
  c->callback([&] { command = [&] { return command_render(o); }; });
}

void add_compare(CLI::App& app, CompareOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand(
      "compare", "Whether two runs, or one scene on two backends, differ by more than rounding");
  c->add_option("INPUT", o.inputs, "Two run files (run.vtkhdf), or one scene file with --between")
      ->required();
  c->add_option("--between", o.between,
                "A,B: two sides BACKEND:PRECISION or BACKEND:PRECISION@THREADS")
      ->delimiter(',');
  add_overrides(c, o.overrides);
  c->add_option("--set-b", o.overrides_b, "The same for B alone, to see what a key changes")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--warmup", o.warmup, "Updates on A before the frozen step")
      ->transform(whole_number(0, 1000000000));
  c->add_option("--updates", o.updates, "Updates after it")->transform(whole_number(1, 1000000000));
  c->add_option("--members", o.members, "Randomly rounded references that give the tolerances")
      ->transform(whole_number(2, 1000));
  c->add_option("--seed", o.seed, "Of the random roundings")
      ->transform(whole_number(0, std::numeric_limits<std::int64_t>::max()));
  c->add_option("--report", o.report,
                "Write the result to this file: .html, with diagrams, or .json");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->footer(help::kCompareHelp);
  c->callback([&] { command = [&] { return command_compare(o); }; });
}

void add_config(CLI::App& app, ConfigOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand("config", "The scene format");
  CLI::Option_group* one = c->add_option_group("what");
  one->add_flag("--example", o.example, "The reference scene: every key, default, unit, meaning");
  one->add_flag("--schema", o.schema, "JSON Schema of a scene file, for editors");
  one->require_option(1);
  c->footer("Example:\n  pbf config --example > my_scene.yaml");
  c->callback([&] { command = [&] { return command_config(o); }; });
}

void add_bench(CLI::App& app, BenchOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand(
      "bench", "Time per update and per stage over sizes, backends, precisions and threads");
  CLI::Option* scenes =
      c->add_option("SCENE", o.scenes, "Scene files; a built-in dam break when none is given");
  c->add_flag("--calibrate", o.calibrate,
              "Time every pass of the built-in scene and store it, for the times of pbf plan, in "
              "$PBF_CALIBRATION, else ~/.local/share/pbf/calibration.csv")
      ->excludes(scenes);
  c->add_option("--n", o.particles, "Numbers of particles, separated by commas")
      ->delimiter(',')
      ->transform(whole_number(1));
  c->add_option("--backend", o.backends, "cpu, cuda or both, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember({"cpu", "cuda"}));
  c->add_option("--precision", o.precisions, "float, double or both")
      ->delimiter(',')
      ->check(CLI::IsMember({"float", "double"}));
  c->add_option("--threads", o.threads,
                "Numbers of CPU threads; as a run would choose when not given")
      ->delimiter(',')
      ->transform(whole_number(1, 4096));
  add_overrides(c, o.overrides);
  c->add_option("--warmup", o.warmup, "Updates before the state counts as late")
      ->transform(whole_number(0));
  c->add_option("--updates", o.updates, "Updates of one repeat")->transform(whole_number(1));
  c->add_option("--repeats", o.repeats, "Repeats; the median counts")->transform(whole_number(1));
  c->add_option("--csv", o.csv, "Write the table to this file");
  c->add_option("--json", o.json, "Write the table to this file, as a JSON array");
  c->footer(help::kBenchHelp);
  c->callback([&] { command = [&] { return command_bench(o); }; });
}

void add_batch(CLI::App& app, BatchOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand(
      "batch", "Many scenes, or one with a grid of settings: each run in a process of its own");
  c->add_option("INPUT", o.input,
                "Folder of scenes (*.yaml), a scene, or a list: a scene on each line, then "
                "KEY.PATH=VALUE where wanted")
      ->required();
  c->add_option("--out", o.out, "Folder of the run folders; out/batch_<name> when not given");
  c->add_option("--grid", o.grid,
                "KEY=V1,V2,...: a run for every value; repeatable, then for every combination")
      ->take_all()
      ->allow_extra_args(false);
  add_overrides(c, o.overrides);
  c->add_option("--jobs", o.jobs, "Runs at a time")->transform(whole_number(1, 4096));
  c->add_option("--threads", o.threads, "CPU threads of a run; all, shared among --jobs")
      ->transform(whole_number(1, 4096));
  c->add_option("--max-walltime", o.max_walltime, "Stop all after so many seconds, save, exit 75")
      ->transform(seconds_above_0());
  CLI::Option* only = c->add_option("--only", o.only, "Run this one alone, counted from 0")
                          ->transform(whole_number(0));
  c->add_flag("--collect", o.collect, "Run nothing, write the summary of what is there")
      ->excludes(only);
  c->add_flag("--strict", o.strict, "A warning ends its run with exit 6");
  c->add_flag("--list", o.list, "Print the runs and do nothing");
  c->add_flag("--slurm", o.slurm, "Print a Slurm array script and do nothing");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->footer(help::kBatchHelp);
  c->callback([&] { command = [&] { return command_batch(o); }; });
}

void add_study(CLI::App& app, StudyOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand("study", "Error against run time over a grid of settings");
  c->add_option("STUDY", o.study, "Study file (YAML)")->required();
  c->add_option("--out", o.out, "Folder of the tables; out/study_<name> when not given");
  c->add_option("--set", o.overrides,
                "Replace one key of the scene in every run, KEY.PATH=VALUE; the study's variants "
                "and grid come after it")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--repeats", o.repeats, "Repeats of the timing; as the study says when not given")
      ->transform(whole_number(1, 1000));
  c->add_flag("--list", o.list, "Print the runs and do nothing");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->footer(std::string(help::kStudyHelp) + help::diagnostics_text() + help::kStudyMeasures);
  c->callback([&] { command = [&] { return command_study(o); }; });
}

void add_stability(CLI::App& app, StabilityCommandOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand(
      "stability", "Stiff and extreme cases, a verdict for each; maps of where a scene is stable");
  c->add_option("CASE", o.cases,
                "Cases or groups of the suite, all when none is given; with --map "
                "the scene file (configs/stiff/pool.yaml)");
  c->add_option("--suite", o.suite, "Suite file (configs/stability.yaml)");
  c->add_option("--backend", o.backend, "Where to run")->check(CLI::IsMember({"cpu", "cuda"}));
  c->add_option("--precision", o.precision, "Of the computation")
      ->check(CLI::IsMember({"float", "double"}));
  c->add_flag("--reduced", o.reduced, "Fewer particles and updates, where the suite says so");
  c->add_option("--jobs", o.jobs, "Cases at once; all CPU threads when not given, 1 on cuda")
      ->transform(whole_number(1, 4096));
  add_overrides(c, o.overrides);
  c->add_option("--csv", o.csv, "Write the table to this file");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  CLI::Option* map = c->add_option(
      "--map", o.map, "X_KEY,Y_KEY: run a scene over a grid of two of its keys instead");
  for (const auto& [name, values] : {std::pair{"--x", &o.x}, {"--y", &o.y}})
    c->add_option(name, *values,
                  "Values along this axis of the map: a,b,c or LOW:HIGH:COUNT in equal ratios; the "
                  "scene's own times 1/4 ... 8 when not given")
        ->needs(map);
  c->add_option("--iterations", o.iterations, "Of the map, separated by commas")
      ->delimiter(',')
      ->transform(whole_number(0, 100000))
      ->needs(map);
  c->add_option("--limit", o.limit, "Mean compression above which a run of a map is degraded")
      ->transform(number_from(0, false, ""))
      ->needs(map);
  c->footer(help::kStabilityHelp);
  c->callback([&] { command = [&] { return command_stability(o); }; });
}

void add_info(CLI::App& app, Command& command) {
  CLI::App* c = app.add_subcommand("info", "Version, build features, libraries, devices");
  c->footer("Example:\n  pbf info");
  c->callback([&] { command = command_info; });
}

/// CLI11's message, the unknown command by its name, and where to read on.
std::string explain(const CLI::App& app, const CLI::ParseError& e, int argc, char** argv) {
  const auto chosen = app.get_subcommands();
  if (!chosen.empty())
    return std::string(e.what()) + "\nSee pbf " + chosen[0]->get_name() + " --help";
  std::string message = e.what();
  if (argc > 1 && argv[1][0] != '-') message = std::string(argv[1]) + ": unknown command";
  message += "; the commands are";
  for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; }))
    message += " " + c->get_name();
  return message + "\nSee pbf --help";
}

int run_main(int argc, char** argv) {
  CLI::App app("pbf: Position Based Fluids, from a scene file to HDF5 and pictures.", "pbf");
  app.set_version_flag("--version", "pbf " + build_info().version);
  app.require_subcommand(1);
  app.footer(help::kExitCodes);
  RunOptions run;
  PlanOptions plan;
  RenderOptions render;
  CompareOptions compare;
  ConfigOptions config;
  BenchOptions bench;
  StudyOptions study;
  BatchOptions batch;
  StabilityCommandOptions stability;
  Command command;
  add_run(app, run, command);
  add_plan(app, plan, command);
  add_render(app, render, command);
  add_compare(app, compare, command);
  add_config(app, config, command);
  add_bench(app, bench, command);
  add_study(app, study, command);
  add_batch(app, batch, command);
  add_stability(app, stability, command);
  add_info(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) {  // --help, --version; on stdout, where a lost write is seen
      std::ostringstream text;
      app.exit(e, text, text);
      std::fputs(text.str().c_str(), stdout);
      return 0;
    }
    throw Error(ExitCode::bad_input, explain(app, e, argc, argv));
  }
  return command();
}

int fail(ExitCode code, const std::string& message) {
  // Messages quote what anyone wrote: arguments, file names, the environment, strangers' files.
  std::fprintf(stderr, "pbf: error: %s\n", escaped(message).c_str());
  return static_cast<int>(code);
}

int guarded(int argc, char** argv) {
  try {
    const int code = run_main(argc, argv);
    finish_stdout();
    return code;
  } catch (const Error& e) {
    return fail(e.code(), e.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::unavailable,
                "not enough memory; use fewer particles (a larger fluid.spacing) or a machine "
                "with more memory (pbf plan says how much a scene needs)");
  } catch (const std::exception& e) {
    return fail(ExitCode::internal, std::string("internal error: ") + e.what());
  }
}

}  // namespace
}  // namespace pbf::inline app_module

int main(int argc, char** argv) {
  pbf::hold_standard_streams();
  pbf::see_failed_writes();
  return pbf::guarded(argc, argv);
}
