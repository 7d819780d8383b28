// pbf compare: two run files, or one scene on two backends.
#include "lib/verify/compare.h"

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/log.h"
#include "lib/base/output_file.h"
#include "lib/base/stage_clock.h"
#include "lib/io/run_path.h"
#include "lib/run/load_run.h"

namespace pbf::app_module {
namespace {

struct CompareOptions : SceneOptions {
  std::vector<std::string> inputs;       ///< two run files, or one scene with `between`
  std::vector<std::string> between;      ///< two sides, BACKEND:PRECISION[@THREADS]
  std::vector<std::string> overrides_b;  ///< for B only
  CompareSettings settings;
  std::string report;  ///< path of a .json; empty: none
  std::string junit;   ///< path; empty: none
  bool quiet = false;
};

const char* const kCompareHelp =
    "With --between: one update from one state, stage by stage; then how far particles drift\n"
    "apart; then statistics that chaos leaves alone. Each against what rounding at random does\n"
    "to references in double on the CPU (so allow for their time: the number of --members).\n"
    "Of two run files: the scenes' physics; status, end, frames, fields and rows of the log, "
    "where\n"
    "what only one file holds is a difference; particles, where the same bits are promised; the\n"
    "particles of every frame as two samples. There, values up to 16 roundings apart are equal:\n"
    "of the coarser of computed and stored precision, relative to the box for positions, to the\n"
    "box over a step for velocities, to 1 + box/h for densities. A difference of all the fluid\n"
    "at once, after chaos has grown, may still be one of rounding: --between tells.\n"
    "Exit code 0 when nothing differs by more, 6 when something does.\n"
    "Examples:\n"
    "  pbf compare configs/minimal.yaml --between cpu:double,cuda:float --report compare.json\n"
    "  pbf compare configs/minimal.yaml --between cpu:float@1,cpu:float@2\n"
    "  pbf compare out/a out/b";

void check_report(const std::string& path) {
  if (path.empty() || path.ends_with(".json")) return;
  throw Error(ExitCode::bad_input,
              "--report " + path +
                  ": the name must end in .json; the tables and diagrams of such a "
                  "report are drawn by: python3 -m pbf_tools plot-compare REPORT.json");
}

/// Called after the inputs are known.
void check_reports(const CompareOptions& o) {
  check_outputs("--report", o.report, "--junit", o.junit);
}

CompareResult between(const CompareOptions& o, Log& log) {
  if (o.between.size() != 2)
    throw Error(ExitCode::bad_input,
                "--between needs two sides separated by a comma, e.g. cpu:double,cuda:float");
  if (o.inputs.size() != 1)
    throw Error(ExitCode::bad_input, "--between compares one scene; " +
                                         std::to_string(o.inputs.size()) + " files are given");
  CompareSettings s = o.settings;
  s.a = parse_side(o.between[0]);
  s.b = parse_side(o.between[1]);
  const LoadedScene a = load_scene_or_run(o.inputs[0], o.overrides, o.base_folder);
  std::vector<std::string> more = o.overrides;
  more.insert(more.end(), o.overrides_b.begin(), o.overrides_b.end());
  const LoadedScene b = load_scene_or_run(o.inputs[0], more, o.base_folder);
  check_reports(o);
  CompareResult result = compare_between(a.scene, b.scene, a.folder, s,
                                         [&](const std::string& line) { log.note(line); });
  for (const std::string& key : o.overrides_b) result.notes.push_back("on B alone: " + key);
  return result;
}

CompareResult files(const CompareOptions& o) {
  if (!o.overrides.empty() || !o.overrides_b.empty())
    throw Error(ExitCode::bad_input,
                "--set and --set-b go with --between: run files are what they are");
  if (o.inputs.size() != 2)
    throw Error(ExitCode::bad_input, "two runs are needed, or one scene with --between A,B; " +
                                         std::to_string(o.inputs.size()) + " given");
  const std::string a = only_run_path(o.inputs[0]), b = only_run_path(o.inputs[1]);
  for (const std::string& path : {a, b}) note_input(path);
  check_reports(o);
  return compare_files(a, b);
}

int command_compare(const CompareOptions& o) {
  check_report(o.report);
  Log log(o.quiet);
  const Stopwatch watch;
  const CompareResult result = o.between.empty() ? files(o) : between(o, log);
  log.result(compare_text(result));
  if (!o.report.empty()) write_text_file(o.report, compare_json(result));
  if (!o.junit.empty()) write_text_file(o.junit, compare_junit(result, watch.seconds()));
  return static_cast<int>(result.same() ? ExitCode::done : ExitCode::difference);
}

}  // namespace

void add_compare(CLI::App& app, int& code) {
  const auto [c, o] = add_command(
      app, code, command_compare, "compare",
      "Whether two runs, or one scene on two backends, differ by more than rounding", kCompareHelp);
  c->add_option(
       "INPUT", o.inputs,
       "Two runs (run.vtkhdf, or the folder that it is in), or with --between one scene file, or "
       "a run for its scene")
      ->required();
  c->add_option("--between", o.between,
                "A,B: two sides BACKEND:PRECISION or BACKEND:PRECISION@THREADS")
      ->delimiter(',');
  add_scene_options(c, o);
  add_repeatable(c, "--set-b", o.overrides_b, "The same for B alone, to see what a key changes");
  c->add_option("--warmup", o.settings.warmup, "Updates on A before the frozen step")
      ->transform(whole_number(0, 1000000000));
  c->add_option("--updates", o.settings.updates, "Updates after it")
      ->transform(whole_number(1, 1000000000));
  c->add_option("--members", o.settings.members,
                "Randomly rounded references that give the tolerances")
      ->transform(whole_number(2, 1000));
  c->add_option("--seed", o.settings.seed, "Of the random roundings")
      ->transform(whole_number(0, std::numeric_limits<std::int64_t>::max()));
  c->add_option("--report", o.report,
                "Write the result to this .json file, which pbf_tools plot-compare draws");
  c->add_option("--junit", o.junit, "Write the verdicts to this file, as JUnit XML for CI systems");
  add_quiet(c, o.quiet);
}

}  // namespace pbf::app_module
