// pbf stability: the suite of stiff and extreme cases, and maps over two scene keys.
#include <fmt/core.h>
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <thread>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/json.h"
#include "lib/base/log.h"
#include "lib/base/machine.h"
#include "lib/base/shipped_file.h"
#include "lib/base/stage_clock.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/campaign/stability.h"
#include "lib/campaign/stability_map.h"
#include "lib/run/signals.h"

namespace pbf::app_module {
namespace {

struct StabilityCommandOptions : SceneOptions {
  std::vector<std::string> cases;  ///< names or groups, empty: all; with --map: path of the scene
  std::string suite;               ///< empty: the suite that comes with the program
  std::string backend = "cpu", precision = "float";
  bool reduced = false, quiet = false;
  int jobs = 0;                  ///< cases at a time; 0: number of threads, 1 on a device
  std::string csv, json, junit;  ///< paths, empty: none
  std::string map, x, y;         ///< X_KEY,Y_KEY and their values; empty: no map
  StabilityMap settings;         ///< of the map: iterations and limit
};

const char* const kStabilityHelp =
    "Exit code 6 when a case is not as it must be; 75 when SIGINT or SIGTERM stopped the command,\n"
    "after writing what was done.\n"
    "A map (--map X_KEY,Y_KEY) runs one scene for every combination of values of the two keys\n"
    "(--x, --y) and of solver.iterations (--iterations): 6 x 6 x 5 runs where none is given. "
    "Where\n"
    "gravity or h differ, the time simulated goes with sqrt(h/g), so that the flows are alike.\n"
    "Each run is\n"
    "  stable    it came to the end, with a mean compression over its last quarter up to --limit\n"
    "  degraded  it came to the end, but more compressed: give more iterations or a shorter step\n"
    "  stopped   the guard ended it; the column stopped_for has the reason\n"
    "The table, to stdout or --csv, has a row per run. dt_hat is dt sqrt(g/h), the step without\n"
    "dimension, by which scenes of other sizes can be judged too: where the class changes with\n"
    "it alone, the largest stable dt_hat holds for them. pbf_tools plot-map draws the map.\n"
    "Examples:\n"
    "  pbf stability --reduced --csv stability.csv\n"
    "  pbf stability stiffness column_48 --precision double\n"
    "  pbf stability --map time.step,gravity --x 0.001:0.05:6 --y 1,10,100 --csv map.csv\n"
    "  python -m pbf_tools plot-map map.csv -o map.png";

std::vector<StabilityCase> chosen(const StabilityCommandOptions& o) {
  const std::string suite = o.suite.empty() ? shipped_file("configs/stability.yaml") : o.suite;
  std::vector<StabilityCase> all = read_stability_suite(suite), out;
  if (o.cases.empty()) return all;
  const auto add = [&](const StabilityCase& c) {
    if (std::ranges::count(out, c.name, &StabilityCase::name) == 0) out.push_back(c);
  };
  for (const std::string& name : o.cases) {
    bool found = false;
    for (const StabilityCase& c : all) {
      if (c.name != name && c.group != name) continue;
      found = true;
      // Also run the case that it is compared with.
      for (const StabilityCase& other : all)
        if (other.name == c.must.like) add(other);
      add(c);
    }
    if (!found) {
      std::string names;
      for (const StabilityCase& c : all) names += " " + c.name;
      throw Error(ExitCode::bad_input,
                  "no case or group " + name + " in " + suite + "; the cases are" + names);
    }
  }
  return out;
}

/// Calls work(k) for all k < n on `jobs` threads, with a line of progress after each: "k of n WHAT,
/// time" and name(row). work(k) returns std::optional<Row>; if it is empty, a signal has come: no
/// further work is started, and `code` is that of an early stop. Returns the rows that are done.
/// The first exception is thrown at the end.
template <class Row>
std::vector<Row> in_parallel(std::size_t n, int jobs, Log& log, const char* what, int& code,
                             const auto& work, const auto& name) {
  const Stopwatch watch;
  std::vector<std::optional<Row>> rows(n);
  std::size_t done = 0;
  std::atomic<std::size_t> next{0};
  std::exception_ptr failed;
  std::mutex mutex;
  const auto loop = [&] {
    for (std::size_t k = next++; k < n; k = next++) {
      try {
        std::optional<Row> row = work(k);
        const std::lock_guard lock(mutex);
        if (!row) {
          next = n;
          return;
        }
        log.progress(fmt::format("{} of {} {}, {}{}", ++done, n, what,
                                 duration_text(watch.seconds()), name(*row)));
        rows[k] = std::move(row);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failed) failed = std::current_exception();
        next = n;
      }
    }
  };
  std::vector<std::thread> threads;
  try {
    for (int j = 1; j < jobs; ++j) threads.emplace_back(loop);
  } catch (const std::system_error&) {  // no more threads available: continue with those there are
  }
  loop();
  for (std::thread& t : threads) t.join();
  if (failed) std::rethrow_exception(failed);
  std::vector<Row> out;
  for (auto& row : rows)
    if (row) out.push_back(*std::move(row));
  if (out.size() == n) return out;
  code = static_cast<int>(ExitCode::resumable);
  log.note(
      fmt::format("pbf: stopped early by {} with {} of {} {} done; the same command starts anew",
                  signal_token().why(), out.size(), n, what));
  return out;
}

/// The rows of a table as JSON, where --json asks for it. complete: nothing stopped it early.
void write_json(const StabilityCommandOptions& o, const Table& table, bool complete, double seconds,
                Json out) {
  if (o.json.empty()) return;
  out["version"] = build_info().version;
  out["commit"] = build_info().commit;
  out["complete"] = complete;
  out["seconds"] = seconds;
  out["rows"] = table.json();
  write_text_file(o.json, json_text(out) + "\n");
}

int run_suite(const StabilityCommandOptions& o, const StabilityOptions& run, int jobs) {
  Log log(o.quiet);
  const std::vector<StabilityCase> cases = chosen(o);
  for (const StabilityCase& c : cases) note_input(c.scene);  // so that outputs cannot replace it
  check_outputs("--csv", o.csv, "--junit", o.junit);
  check_outputs("--csv", o.csv, "--json", o.json);
  check_outputs("--json", o.json, "--junit", o.junit);
  const Stopwatch watch;
  int code = static_cast<int>(ExitCode::done);
  auto rows = in_parallel<StabilityRow>(
      cases.size(), jobs, log, "cases", code,
      [&](std::size_t k) { return run_stability_case(cases[k], run); },
      [](const StabilityRow& r) { return ": " + r.name; });
  judge_likeness(cases, rows);
  std::int64_t failed = 0;
  std::string group;
  for (const StabilityRow& r : rows) {
    if (r.group != group) log.result(r.group);
    group = r.group;
    log.result(stability_text(r));
    failed += r.good ? 0 : 1;
  }
  log.result(fmt::format("{} cases on {} {}{}: {} failed, {:.1f} s", rows.size(), o.backend,
                         o.precision, o.reduced ? ", reduced" : "", failed, watch.seconds()));
  if (!o.csv.empty()) write_text_file(o.csv, stability_table(rows, run).csv());
  write_json(o, stability_table(rows, run), rows.size() == cases.size(), watch.seconds(),
             {{"failed", failed}});
  if (!o.junit.empty()) write_text_file(o.junit, stability_junit(rows, run, watch.seconds()));
  if (code == 0 && failed > 0) code = static_cast<int>(ExitCode::difference);
  return code;
}

int run_map(const StabilityCommandOptions& o, const StabilityOptions& run, int jobs) {
  if (o.cases.size() > 1)
    throw Error(ExitCode::bad_input,
                "--map takes one scene file, not " + std::to_string(o.cases.size()));
  StabilityMap map = o.settings;
  map.scene = o.cases.empty() ? shipped_file("configs/stiff/pool.yaml") : o.cases[0];
  map.run = run;
  const std::size_t comma = o.map.find(',');
  if (comma == std::string::npos || o.map.find(',', comma + 1) != std::string::npos)
    throw Error(ExitCode::bad_input, "--map " + o.map + ": expected two keys, time.step,gravity");
  map.x_key = o.map.substr(0, comma);
  map.y_key = o.map.substr(comma + 1);
  map.x = map_values(map.scene, run, map.x_key, o.x);
  map.y = map_values(map.scene, run, map.y_key, o.y);
  check_outputs("--csv", o.csv, "--json", o.json);
  Log log(o.quiet);
  const std::vector<MapCell> grid = map_cells(map);
  log.note(fmt::format("pbf: {} runs of {}: {} values of {}, {} of {}, {} of solver.iterations",
                       grid.size(), map.scene, map.x.size(), map.x_key, map.y.size(), map.y_key,
                       map.iterations.size()));
  const Stopwatch watch;
  int code = static_cast<int>(ExitCode::done);
  const auto cells = in_parallel<MapCell>(
      grid.size(), jobs, log, "runs", code,
      [&](std::size_t k) { return run_map_cell(map, grid[k]); },
      [](const MapCell&) { return std::string(); });
  std::int64_t count[3] = {0, 0, 0};
  for (const MapCell& c : cells) ++count[static_cast<int>(c.verdict)];
  const std::string csv = map_table(cells, map).csv();
  o.csv.empty() ? log.result(csv) : write_text_file(o.csv, csv);
  write_json(o, map_table(cells, map), cells.size() == grid.size(), watch.seconds(),
             {{"limit", map.limit}});
  log.result(
      fmt::format("{} runs: {} stable, {} degraded (mean compression above {:g} %), {} stopped by "
                  "the guard, {:.0f} s",
                  cells.size(), count[0], count[1], 100 * map.limit, count[2], watch.seconds()));
  return code;
}

int command_stability(const StabilityCommandOptions& o) {
  StabilityOptions run;
  run.backend = *named<Backend>(o.backend);
  run.precision = *named<Precision>(o.precision);
  const int jobs = o.jobs > 0 ? o.jobs : about(run.backend).on_device ? 1 : usable_threads();
  run.reduced = o.reduced;
  run.threads = std::max(1, usable_threads() / jobs);
  run.overrides = o.overrides;
  run.base_folder = o.base_folder;
  run.stop = [] { return signal_token().why() != nullptr; };
  watch_signals();
  return o.map.empty() ? run_suite(o, run, jobs) : run_map(o, run, jobs);
}

}  // namespace

void add_stability(CLI::App& app, int& code) {
  const auto [c, o] =
      add_command(app, code, command_stability, "stability",
                  "Stiff and extreme cases, a verdict for each; maps of where a scene is stable",
                  kStabilityHelp);
  c->add_option("CASE", o.cases,
                "Cases or groups of the suite, all when none is given; with --map "
                "the scene file (configs/stiff/pool.yaml)");
  CLI::Option* suite = c->add_option(
      "--suite", o.suite,
      "Suite file; configs/stability.yaml that comes with the program when not given");
  add_backend(c, o.backend, o.precision);
  CLI::Option* reduced =
      c->add_flag("--reduced", o.reduced, "Fewer particles and updates, where the suite says so");
  c->add_option("--jobs", o.jobs, "Cases at once; all CPU threads when not given, 1 on cuda")
      ->transform(whole_number(1, 4096));
  add_scene_options(c, o);
  c->add_option("--csv", o.csv, "Write the table to this file");
  c->add_option("--json", o.json, "Write the rows to this file, as one JSON object");
  CLI::Option* junit = c->add_option(
      "--junit", o.junit, "Write the verdicts to this file, as JUnit XML for CI systems");
  add_quiet(c, o.quiet);
  CLI::Option* map = c->add_option(
      "--map", o.map,
      "X_KEY,Y_KEY: run one scene over values of two of its keys and of solver.iterations, "
      "and say where it is stable (see below)");
  for (CLI::Option* of_suite : {junit, reduced, suite}) of_suite->excludes(map);
  for (const auto& [name, values] : {std::pair{"--x", &o.x}, {"--y", &o.y}})
    c->add_option(
         name, *values,
         "Values of this key: V1,V2,... or FIRST:LAST:COUNT in equal ratios, both ends included "
         "(--grid of pbf batch takes equal steps); the scene's own times "
         "1/4, 1/2, 1, 2, 4, 8 when not given")
        ->needs(map);
  c->add_option("--iterations", o.settings.iterations,
                "Values of solver.iterations, separated by commas; 1,2,4,8,16 when not given")
      ->delimiter(',')
      ->transform(whole_number(0, 100000))
      ->needs(map);
  c->add_option("--limit", o.settings.limit,
                "Mean compression above which a run of a map is degraded; 0.01 is 1 %, and taken "
                "when not given")
      ->transform(number_from(0, false, ""))
      ->needs(map);
}

}  // namespace pbf::app_module
