// The command line of pbf; every error ends here, as one message and an exit code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>

#include "app/commands.h"
#include "app/signals.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/version.h"

namespace pbf {
namespace {

constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0   done\n"
    "  1   internal error\n"
    "  2   bad command line or scene\n"
    "  3   run stopped by the stability guard\n"
    "  4   backend, device or memory not available\n"
    "  5   file cannot be read or written (disk full)\n"
    "  6   compare found a difference, batch has failed runs, a suite found a failure\n"
    "  75  stopped early by a signal or the wall-time limit, after saving\n\n"
    "Example: pbf run configs/dam_break.yaml --out out/dam_break";

constexpr const char* kMeasures =
    "Measures (formulas: lib/diag/README.md; c = max(rho/rho0 - 1, 0) of a particle, walls\n"
    "included; H0 = volume of the fluid / area of the floor):\n"
    "  compression_mean, _rms, _p99, _max   sum c/N, sqrt(sum c^2/N), 99th percentile, max c [1]\n"
    "  share_above_1, share_above_10        particles with c > 1 %, c > 10 % [1]\n"
    "  height_kept            2 x height of the centre of mass above the floor / H0 [1]\n"
    "  hydrostatic_deviation  RMS of (weight above z - rho0 g (H0 - z)) / (rho0 g H0) [1]\n"
    "  energy_drift           (E - E0)/E0, E above the box's lowest corner [1]\n"
    "  energy_rise            largest E - (lowest E before), over E0 [1]\n"
    "  momentum [kg m/s], front (largest coordinate) [m], speed_max [m/s]\n"
    "  penetration            farthest that a particle is behind its clamp at a wall [m]\n";

using Command = std::function<int()>;

std::string positive_seconds(const std::string& text) {
  char* end = nullptr;
  const double s = std::strtod(text.c_str(), &end);
  return *end == '\0' && s > 0 && s < 1e300 ? std::string()
                                            : text + " is not a number of seconds above 0";
}

void add_overrides(CLI::App* c, std::vector<std::string>& overrides) {
  c->add_option("--set", overrides, "Replace one key of the scene, KEY.PATH=VALUE; repeatable")
      ->take_all()
      ->allow_extra_args(false);
}

void add_run(CLI::App& app, RunOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand("run", "Simulate a scene: run.h5 and pictures in one folder");
  c->add_option("SCENE", o.scene, "Scene file (YAML), or the run file of a run to repeat")
      ->required();
  c->add_option("--out", o.out, "Run folder; out/<scene name> when not given");
  c->add_option("--backend", o.backend, "Where to run")->check(CLI::IsMember({"cpu", "cuda"}));
  c->add_option("--precision", o.precision, "Of the computation")
      ->check(CLI::IsMember({"float", "double"}));
  c->add_option("--threads", o.threads, "CPU threads")->check(CLI::Range(1, 4096));
  add_overrides(c, o.overrides);
  CLI::Option* overwrite =
      c->add_flag("--overwrite", o.overwrite, "Replace the run in an existing folder");
  c->add_flag(
       "--resume", o.resume,
       "Go on from the last checkpoint; leave a finished run as it is and exit 0, or prolong "
       "it to a later time.end; start it when the folder is not there")
      ->excludes(overwrite);
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->add_option("--log-json", o.log_json, "One JSON object per line and measure, into this file");
  c->add_option("--max-walltime", o.max_walltime, "Stop after so many seconds, save, exit 75")
      ->check(positive_seconds);
  c->footer(
      std::string("Examples:\n") +
      "  pbf run configs/dam_break.yaml\n"
      "  pbf run configs/dam_break.yaml --out out/fine --set fluid.spacing=0.01 --threads 8\n"
      "  pbf run configs/dam_break.yaml --set checkpoint.every=60 --resume\n"
      "  pbf run out/fine/run.h5 --out out/again\n"
      "SIGTERM and SIGINT finish the update, save a checkpoint and exit 75, as --max-walltime\n"
      "does; a second one ends at once. SIGUSR1 saves a checkpoint and goes on.\n"
      "Exit codes are listed in pbf --help.\n\n" +
      kMeasures);
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
  c->footer(
      "The time per update is an estimate from what `pbf bench --calibrate` has stored on this\n"
      "machine; without it none is printed.\n"
      "Example:\n  pbf plan configs/dam_break.yaml --set fluid.spacing=0.005");
  c->callback([&] { command = [&] { return command_plan(o); }; });
}

void add_render(CLI::App& app, RenderOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand("render", "Pictures from the frames of a run file");
  c->add_option("RUN", o.run, "Run file (run.h5)")->required();
  c->add_option("--frames", o.frames, "all, k, a:b or a:b:step; b excluded, negative from the end");
  c->add_option("--size", o.size, "WIDTHxHEIGHT in pixels");
  c->add_option("--camera", o.camera, "position=x,y,z;target=x,y,z;fov=degrees;orbit=degrees/s");
  c->add_option("--color", o.color, "What colours the particles")
      ->check(CLI::IsMember({"speed", "density", "id"}));
  c->add_option("--range", o.range, "LOW,HIGH of the colour bar, in the unit of the field");
  c->add_option("--out", o.out, "Folder of the pictures; render/ beside the run file");
  c->footer(
      "Example:\n"
      "  pbf render out/dam_break/run.h5 --frames 0:-1:5 --size 1920x1080 --color density \\\n"
      "      --camera 'position=3,-4,2;fov=30'");
  c->callback([&] { command = [&] { return command_render(o); }; });
}

void add_compare(CLI::App& app, CompareOptions& o, Command& command) {
  CLI::App* c = app.add_subcommand(
      "compare", "Whether two runs, or one scene on two backends, differ by more than rounding");
  c->add_option("INPUT", o.inputs, "Two run files (run.h5), or one scene file with --between")
      ->required();
  c->add_option("--between", o.between,
                "A,B: two sides BACKEND:PRECISION or BACKEND:PRECISION@THREADS")
      ->delimiter(',');
  add_overrides(c, o.overrides);
  c->add_option("--set-b", o.overrides_b, "The same for B alone, to see what a key changes")
      ->take_all()
      ->allow_extra_args(false);
  c->add_option("--warmup", o.warmup, "Updates on A before the frozen step")
      ->check(CLI::Range(0, 1000000000));
  c->add_option("--updates", o.updates, "Updates after it")->check(CLI::Range(1, 1000000000));
  c->add_option("--members", o.members, "Randomly rounded references that give the tolerances")
      ->check(CLI::Range(2, 1000));
  c->add_option("--seed", o.seed, "Of the random roundings");
  c->add_option("--report", o.report, "Write the result to this file: .html, .json or .png");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->footer(
      "With --between: one update from one state, stage by stage; then how far particles drift\n"
      "apart; then statistics that chaos leaves alone. Each against what rounding at random does\n"
      "to references in double on the CPU (so allow for their time: the number of --members).\n"
      "Exit code 0 when nothing differs by more, 6 when something does.\n"
      "Examples:\n"
      "  pbf compare configs/minimal.yaml --between cpu:double,cuda:float --report compare.html\n"
      "  pbf compare configs/minimal.yaml --between cpu:float@1,cpu:float@2\n"
      "  pbf compare out/a/run.h5 out/b/run.h5");
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
      ->check(CLI::Range(std::int64_t(1), std::int64_t(2147483647)));
  c->add_option("--backend", o.backends, "cpu, cuda or both, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember({"cpu", "cuda"}));
  c->add_option("--precision", o.precisions, "float, double or both")
      ->delimiter(',')
      ->check(CLI::IsMember({"float", "double"}));
  c->add_option("--threads", o.threads, "Numbers of CPU threads; all when not given")
      ->delimiter(',')
      ->check(CLI::Range(1, 4096));
  add_overrides(c, o.overrides);
  c->add_option("--warmup", o.warmup, "Updates before the state counts as late")
      ->check(CLI::NonNegativeNumber);
  c->add_option("--updates", o.updates, "Updates of one repeat")->check(CLI::PositiveNumber);
  c->add_option("--repeats", o.repeats, "Repeats; the median counts")->check(CLI::PositiveNumber);
  c->add_option("--csv", o.csv, "Write the table to this file");
  c->add_option("--json", o.json, "Write the table to this file, as a JSON array");
  c->footer(
      "Two lines per case: from the first updates on (start), and after the warm-up (late).\n"
      "Stage times on cuda are those of one update in 64 to 1024, timed by\n"
      "device events, and share the time of all.\n"
      "Examples:\n"
      "  pbf bench --n 10000,100000 --backend cpu --threads 1,2 --precision float,double \\\n"
      "      --csv bench.csv\n"
      "  pbf bench --calibrate --n 10000,100000 --warmup 100 --updates 20");
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
  c->add_option("--jobs", o.jobs, "Runs at a time")->check(CLI::Range(1, 4096));
  c->add_option("--threads", o.threads, "CPU threads of a run; all, shared among --jobs")
      ->check(CLI::Range(1, 4096));
  c->add_option("--max-walltime", o.max_walltime, "Stop all after so many seconds, save, exit 75")
      ->check(positive_seconds);
  CLI::Option* only = c->add_option("--only", o.only, "Run this one alone, counted from 0")
                          ->check(CLI::NonNegativeNumber);
  c->add_flag("--collect", o.collect, "Run nothing, write the summary of what is there")
      ->excludes(only);
  c->add_flag("--list", o.list, "Print the runs and do nothing");
  c->add_flag("--slurm", o.slurm, "Print a Slurm array script and do nothing");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->footer(
      "Every run is `pbf run --resume` in a folder of its own: what is finished is left alone,\n"
      "what was stopped or killed goes on, so the same command can be given again until all is\n"
      "done. OUT/summary.csv has a row per run: why it ended, its last measures. SIGTERM, SIGINT\n"
      "and --max-walltime save all runs.\n"
      "Exit code 0 when all are finished, 75 when some are to go on, 6 when some failed.\n"
      "Examples:\n"
      "  pbf batch configs/dam_break.yaml --grid solver.iterations=2,4,8 \\\n"
      "      --grid time.step=0.002,0.001 --jobs 2\n"
      "  pbf batch scenes/ --out out/scenes --set checkpoint.every=60\n"
      "  pbf batch scenes/ --out out/scenes --slurm > job.sh; sbatch job.sh");
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
      ->check(CLI::Range(1, 1000));
  c->add_flag("--list", o.list, "Print the runs and do nothing");
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->footer(
      std::string(
          "A study file:\n"
          "  scene: ../dam_break.yaml           # from this file's folder\n"
          "  set: {time.end: 0.5, render: off}  # keys of the scene, for every run\n"
          "  variants:                          # curves; each a set of keys\n"
          "    - {name: paper, set: {solver.kernels: paper}}\n"
          "    - {name: consistent}\n"
          "  grid:                              # every combination of these entries;\n"
          "    - {solver.iterations: [1, 4]}    # keys of one entry vary together\n"
          "    - {time.step: [0.002, 0.001], measure_every: [10, 20]}\n"
          "  error: compression_mean            # set against the run time [default]\n"
          "  targets: [0.01, 0.001]             # of the error [default]\n"
          "  from: 0.1                          # s, measures count from here [0]\n"
          "  repeats: 3                         # of the timing [default]\n"
          "  clock: wall                        # or cpu, of all threads: on busy machines\n"
          "  energy_limit: 0.03                 # larger energy_rise: no verdict [default]\n"
          "  projection: [0.2, 0.4]             # s, compare with the exact projection\n"
          "  reference: {solver.iterations: 64} # keys; reference_distance to this run\n"
          "  front: {axis: x, length: 0.1, factor: 2, data: [front.csv]}\n"
          "                                     # T = t sqrt(factor g/length), Z = x/length\n"
          "Results are kept per run in OUT/members: the same command goes on where a killed\n"
          "one ended, and runs only what is new. OUT/study.csv and study.json hold the table:\n"
          "compression and pool measures are means over time (compression_rms: root of the\n"
          "mean square, maxima: the largest) from `from` on, seconds_median those of all\n"
          "updates. * in the table on the terminal: no other run is both faster and better.\n"
          "\n") +
      kMeasures +
      "  projection_mean, _rms, _max  distance of one update from the exact projection [spacings]\n"
      "  reference_distance     RMS distance of the centres of mass / (volume)^(1/3) [1]\n"
      "  front_rms_<data>       RMS of Z - Z published [1]; all fronts in OUT/front.csv\n\n"
      "Example:\n"
      "  pbf study configs/study/dam_break.yaml --out out/study --set threads=2");
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
      ->check(CLI::Range(1, 4096));
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
      ->check(CLI::Range(0, 100000))
      ->needs(map);
  c->add_option("--limit", o.limit, "Mean compression above which a run of a map is degraded")
      ->check(CLI::NonNegativeNumber)
      ->needs(map);
  c->footer(
      "Exit code 6 when a case is not as it must be.\n"
      "Examples:\n"
      "  pbf stability --reduced --csv stability.csv\n"
      "  pbf stability stiffness column_48 --precision double\n"
      "  pbf stability --map time.step,gravity --x 0.001:0.05:6 --y 1,10,100 --csv map.csv\n"
      "  python -m pbf_tools plot-map map.csv -o map.png");
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
  app.footer(kExitCodes);
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
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    throw Error(ExitCode::bad_input, explain(app, e, argc, argv));
  }
  return command();
}

int fail(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "pbf: error: %s\n", message.c_str());
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
}  // namespace pbf

int main(int argc, char** argv) {
  pbf::ignore_closed_pipes();
  return pbf::guarded(argc, argv);
}
