// pbf bench: time per update over sizes, backends, precisions and threads.
#include <fmt/core.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/stages.h"
#include "lib/base/version.h"
#include "lib/campaign/bench.h"
#include "lib/campaign/calibration.h"
#include "lib/campaign/grid.h"
#include "lib/io/table.h"
#include "lib/run/load_run.h"

namespace pbf::app_module {
namespace {

struct BenchOptions : SceneOptions {
  std::vector<std::string> scenes;  ///< paths; empty: the built-in dam break
  std::vector<std::int64_t> particles{10000, 100000};
  std::vector<std::string> backends{"cpu"}, precisions{"float"};
  std::vector<int> threads{0};  ///< 0: as a run would choose
  BenchSettings settings;
  std::string csv, json;   ///< paths, empty: none
  bool calibrate = false;  ///< store the costs of the stages for `pbf plan`
};

const char* const kBenchHelp =
    "Two lines per case: from the first updates on (start), and after the warm-up (late).\n"
    "Stage times on cuda are those of one update in 64 to 1024, timed by\n"
    "device events, and share the time of all. With time.adaptive an update is one step here.\n"
    "Examples:\n"
    "  pbf bench --n 10000,100000 --backend cpu --threads 1,2 --precision float,double \\\n"
    "      --csv bench.csv\n"
    "  pbf bench --calibrate --n 10000,100000 --warmup 100 --updates 20";

std::vector<Column<BenchRow>> columns() {
  using R = const BenchRow&;
  std::vector<Column<BenchRow>> all{
      {"scene", [](R r) { return r.scene; }},
      {"backend", [](R r) { return r.solver.backend; }},
      {"device", [](R r) { return r.solver.device; }},
      {"driver", [](R r) { return r.solver.driver; }},
      {"commit", [](R) { return build_info().commit; }},
      {"precision", [](R r) { return r.solver.precision; }},
      {"threads", [](R r) { return r.solver.threads; }},
      {"n_particles", [](R r) { return r.particles; }},
      {"state", [](R r) { return r.state; }},
      {"first_update", [](R r) { return r.first_update; }},
      {"updates", [](R r) { return r.settings.updates; }},
      {"repeats", [](R r) { return r.settings.repeats; }},
      {"iterations", [](R r) { return r.iterations; }},
      {"dt", [](R r) { return r.dt; }},
      {"ms_per_step_median", [](R r) { return r.ms_median; }},
      {"ms_min", [](R r) { return r.ms_min; }},
      {"ms_max", [](R r) { return r.ms_max; }},
      {"cpu_ms_per_step_median", [](R r) { return r.cpu_ms_median; }},
      {"us_per_particle", [](R r) { return r.ms_median * 1e3 / double(r.particles); }},
      {"neighbors_mean", [](R r) { return r.measures.neighbors_mean; }},
      {"neighbors_max", [](R r) { return r.measures.neighbors_max; }},
      {"density_error_avg", [](R r) { return r.measures.compression_mean; }},
      {"density_error_max", [](R r) { return r.measures.compression_max; }},
      {"bytes_per_particle", [](R r) { return double(r.solver.bytes) / double(r.particles); }},
      {"peak_mb", [](R r) { return r.peak_mb; }},
      {"launches_per_update",
       [](R r) { return r.solver.launches > 0 ? Cell(r.solver.launches) : Cell(); }},
      {"exchange_hidden",
       [](R r) { return r.solver.hidden_exchange > 0 ? Cell(r.solver.hidden_exchange) : Cell(); }}};
  for (const Stage& stage : kStages) {
    if (!stage.of_update) continue;
    all.push_back({std::string("ms_") + stage.name, [&stage](R r) {
                     Cell value;  // empty if the scene has no such stage
                     for (const StageTime& s : r.stages)
                       if (s.name == stage.name) value = s.seconds * 1e3;
                     return value;
                   }});
  }
  return all;
}

std::string line(const BenchRow& r) {
  std::string out = fmt::format(
      "{:12} {:4} {:6} {:3} {:10} {:5} {:10.4f} ms ({:.4f}..{:.4f}) {:8.4f} us/particle", r.scene,
      r.solver.backend, r.solver.precision, r.solver.threads, r.particles, r.state, r.ms_median,
      r.ms_min, r.ms_max, r.ms_median * 1e3 / double(r.particles));
  out += fmt::format("  nbrs {:.1f}/{}  {:.0f} B/particle ", r.measures.neighbors_mean,
                     r.measures.neighbors_max, double(r.solver.bytes) / double(r.particles));
  for (const StageTime& s : r.stages) out += fmt::format(" {} {:.4f}", s.name, s.seconds * 1e3);
  return out;
}

/// A note on the duration if it is more than a few seconds; otherwise empty.
std::string forecast(const BenchOptions& o, std::size_t cases) {
  const BenchSettings& b = o.settings;
  const int updates = b.updates * b.repeats * (b.warmup > 0 ? 2 : 1) + b.warmup;
  const auto most = *std::max_element(o.particles.begin(), o.particles.end());
  const double seconds = double(most) * updates / 2e6;
  if (seconds < 3) return "";
  return fmt::format(
      "pbf: {} case{} of {} updates; the largest, {} particles, takes about {:.2g} s at 2 million "
      "particles and updates a second (one CPU thread; GPUs are hundreds of times as fast)",
      cases, cases == 1 ? "" : "s", updates, most, seconds);
}

int command_bench(const BenchOptions& o) {
  Log log(false);
  TableOf<BenchRow> table(columns());
  std::vector<LoadedScene> scenes;
  for (const std::string& path : o.scenes) {
    scenes.push_back(load_scene_or_run(path, o.overrides, o.base_folder));
  }
  if (o.scenes.empty())
    scenes.emplace_back().scene = parse_scene(
        o.calibrate ? calibration_scene_yaml() : bench_scene_yaml(), "built-in scene", o.overrides);
  if (o.calibrate && calibration_path().empty())
    throw Error(ExitCode::bad_input,
                "no place for the calibration: set PBF_CALIBRATION to the path of a file");
  check_outputs("--csv", o.csv, "--json", o.json);
  // Written after every row, so that an interrupted benchmark leaves its results. A pipe cannot be
  // rewritten, so it gets the table at the end.
  const auto store = [&](bool end) {
    if (!o.csv.empty() && is_stream(o.csv) == end) write_text_file(o.csv, table.csv());
    if (!o.json.empty() && is_stream(o.json) == end)
      write_text_file(o.json, json_text(table.json(), 1) + "\n");
  };
  std::vector<StageCosts> costs;
  const std::vector<GridMember> grid =
      grid_members({grid_axis("n", o.particles), grid_axis("backend", o.backends),
                    grid_axis("precision", o.precisions), grid_axis("threads", o.threads)},
                   1000000, "bench");
  if (const std::string text = forecast(o, scenes.size() * grid.size()); !text.empty())
    log.note(text);
  for (const LoadedScene& base : scenes)
    for (const GridMember& m : grid) {
      const Backend backend = *named<Backend>(o.backends[m.at[1]]);
      const bool on_device = about(backend).on_device;
      if (on_device && m.at[3] > 0) continue;  // a device has no threads
      Scene s = scaled_to(base.scene, o.particles[m.at[0]], base.folder);
      s.backend = backend;
      s.precision = *named<Precision>(o.precisions[m.at[2]]);
      s.threads = on_device ? 0 : o.threads[m.at[3]];
      const std::vector<BenchRow> rows = bench(s, base.folder, o.settings);
      if (o.calibrate) costs.push_back(calibration_of(rows.back()));
      for (const BenchRow& row : rows) {
        table.add(row);
        log.result(line(row));
        store(false);
      }
    }
  store(true);
  if (o.calibrate) {
    store_calibration(calibration_path(), costs);
    log.note("stored in " + calibration_path());
  }
  return 0;
}

}  // namespace

void add_bench(CLI::App& app, int& code) {
  const auto [c, o] = add_command(
      app, code, command_bench, "bench",
      "Time per update and per stage over sizes, backends, precisions and threads", kBenchHelp);
  CLI::Option* scenes = c->add_option(
      "SCENE", o.scenes,
      "Scene files, or runs for their scenes; a built-in dam break when none is given");
  c->add_flag("--calibrate", o.calibrate,
              "Time every pass of the built-in scene and store it, for the times of pbf plan, in "
              "$PBF_CALIBRATION, else ~/.local/share/pbf/calibration.csv")
      ->excludes(scenes);
  c->add_option("--n", o.particles, "Numbers of particles, separated by commas")
      ->delimiter(',')
      ->transform(whole_number(1));
  c->add_option("--backend", o.backends, "cpu, cuda or both, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(words_of<Backend>()));
  c->add_option("--precision", o.precisions, "float, double or both")
      ->delimiter(',')
      ->check(CLI::IsMember(words_of<Precision>()));
  c->add_option("--threads", o.threads,
                "Numbers of CPU threads; as a run would choose when not given")
      ->delimiter(',')
      ->transform(whole_number(1, 4096));
  add_scene_options(c, o);
  c->add_option("--warmup", o.settings.warmup, "Updates before the state counts as late")
      ->transform(whole_number(0));
  c->add_option("--updates", o.settings.updates, "Updates of one repeat")
      ->transform(whole_number(1));
  c->add_option("--repeats", o.settings.repeats, "Repeats; the median counts")
      ->transform(whole_number(1));
  c->add_option("--csv", o.csv, "Write the table to this file");
  c->add_option("--json", o.json, "Write the table to this file, as a JSON array");
}

}  // namespace pbf::app_module
