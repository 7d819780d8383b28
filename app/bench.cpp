// pbf bench: time per update over sizes, backends, precisions and threads.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/stages.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/campaign/bench.h"
#include "lib/campaign/calibration.h"
#include "lib/campaign/grid.h"
#include "lib/io/table.h"
#include "lib/scene/load.h"

namespace pbf::inline app_module {
namespace {

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
      {"neighbours_mean", [](R r) { return r.measures.neighbors_mean; }},
      {"neighbours_max", [](R r) { return r.measures.neighbors_max; }},
      {"density_error_avg", [](R r) { return r.measures.compression_mean; }},
      {"density_error_max", [](R r) { return r.measures.compression_max; }},
      {"bytes_per_particle", [](R r) { return double(r.solver.bytes) / double(r.particles); }},
      {"peak_mb", [](R r) { return r.peak_mb; }},
      {"launches_per_update",
       [](R r) { return r.solver.launches > 0 ? Cell(r.solver.launches) : Cell(); }}};
  for (const Stage& stage : kStages) {
    if (!stage.of_update) continue;
    all.push_back({std::string("ms_") + stage.name, [&stage](R r) {
                     Cell value;  // empty: the scene has no such stage
                     for (const StageTime& s : r.stages)
                       if (s.name == stage.name) value = s.seconds * 1e3;
                     return value;
                   }});
  }
  return all;
}

std::string line(const BenchRow& r) {
  std::string out =
      format("%-12s %-4s %-6s %3d %10lld %-5s %10.4f ms (%.4f..%.4f) %8.4f us/particle",
             r.scene.c_str(), r.solver.backend.c_str(), r.solver.precision.c_str(),
             r.solver.threads, static_cast<long long>(r.particles), r.state.c_str(), r.ms_median,
             r.ms_min, r.ms_max, r.ms_median * 1e3 / double(r.particles));
  out += format("  nbrs %.1f/%lld  %.0f B/particle ", r.measures.neighbors_mean,
                static_cast<long long>(r.measures.neighbors_max),
                double(r.solver.bytes) / double(r.particles));
  for (const StageTime& s : r.stages) out += format(" %s %.4f", s.name.c_str(), s.seconds * 1e3);
  return out;
}

}  // namespace

int command_bench(const BenchOptions& o) {
  Log log(false);
  TableOf<BenchRow> table(columns());
  std::vector<std::pair<Scene, std::string>> scenes;  // with the folder of the file
  if (o.scenes.empty())
    scenes.push_back({parse_scene(o.calibrate ? calibration_scene_yaml() : bench_scene_yaml(),
                                  "built-in scene", o.overrides),
                      "."});
  for (const std::string& path : o.scenes)
    scenes.push_back(
        {load_scene(path, o.overrides).scene, std::filesystem::path(path).parent_path().string()});
  check_output("--csv", o.csv);
  check_output("--json", o.json);
  if (!o.csv.empty() && !o.json.empty() && same_output(o.csv, o.json))
    throw Error(ExitCode::bad_input, "--csv and --json name one file: " + o.csv);
  // After every row, so that a long benchmark that is cut off leaves its results. What goes into a
  // pipe cannot be replaced: it waits for the end.
  const auto store = [&](bool end) {
    if (!o.csv.empty() && is_stream(o.csv) == end) write_text_file(o.csv, table.csv());
    if (!o.json.empty() && is_stream(o.json) == end)
      write_text_file(o.json, json_text(table.json(), 1) + "\n");
  };
  std::vector<StageCosts> costs;
  const BenchSettings settings{o.warmup, o.updates, o.repeats};
  const std::vector<GridMember> grid =
      grid_members({grid_axis("n", o.particles), grid_axis("backend", o.backends),
                    grid_axis("precision", o.precisions), grid_axis("threads", o.threads)},
                   1000000, "bench");
  for (const auto& [base, dir] : scenes)
    for (const GridMember& m : grid) {
      const bool cuda = o.backends[m.at[1]] == "cuda";
      if (cuda && m.at[3] > 0) continue;  // threads are the CPU's alone
      Scene s = scaled_to(base, o.particles[m.at[0]], dir);
      s.backend = cuda ? Backend::cuda : Backend::cpu;
      s.precision = o.precisions[m.at[2]] == "double" ? Precision::dbl : Precision::single;
      s.threads = cuda ? 0 : o.threads[m.at[3]];
      const std::vector<BenchRow> rows = bench(s, dir, settings);
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

}  // namespace pbf::inline app_module
