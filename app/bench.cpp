// pbf bench: time per update over sizes, backends, precisions and threads.
#include <filesystem>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/stages.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/campaign/bench.h"
#include "lib/campaign/calibration.h"
#include "lib/io/report.h"
#include "lib/scene/load.h"

namespace pbf::inline app_module {
namespace {

std::vector<std::string> columns() {
  std::vector<std::string> c{"scene",
                             "backend",
                             "device",
                             "driver",
                             "commit",
                             "precision",
                             "threads",
                             "n_particles",
                             "state",
                             "first_update",
                             "updates",
                             "repeats",
                             "iterations",
                             "dt",
                             "ms_per_step_median",
                             "ms_min",
                             "ms_max",
                             "cpu_ms_per_step_median",
                             "us_per_particle",
                             "neighbours_mean",
                             "neighbours_max",
                             "density_error_avg",
                             "density_error_max",
                             "bytes_per_particle",
                             "peak_mb",
                             "launches_per_update"};
  for (const Stage& s : kStages)
    if (s.of_update) c.push_back(std::string("ms_") + s.name);
  return c;
}

std::vector<Cell> cells(const std::string& scene, const BenchRow& r) {
  const auto i = [](auto v) { return Cell(std::int64_t(v)); };
  const double n = double(r.particles);
  std::vector<Cell> c{scene,
                      r.solver.backend,
                      r.solver.device,
                      r.solver.driver,
                      build_info().commit,
                      r.solver.precision,
                      i(r.solver.threads),
                      i(r.particles),
                      r.state,
                      i(r.first_update),
                      i(r.settings.updates),
                      i(r.settings.repeats),
                      i(r.iterations),
                      r.dt,
                      r.ms_median,
                      r.ms_min,
                      r.ms_max,
                      r.cpu_ms_median,
                      r.ms_median * 1e3 / n,
                      r.measures.neighbors_mean,
                      i(r.measures.neighbors_max),
                      r.measures.compression_mean,
                      r.measures.compression_max,
                      double(r.solver.bytes) / n,
                      r.peak_mb,
                      r.solver.launches > 0 ? Cell(r.solver.launches) : Cell()};
  for (const Stage& stage : kStages) {
    if (!stage.of_update) continue;
    Cell value;  // empty: the scene has no such stage
    for (const StageTime& s : r.stages)
      if (s.name == stage.name) value = s.seconds * 1e3;
    c.push_back(value);
  }
  return c;
}

std::string line(const std::string& scene, const BenchRow& r) {
  std::string out =
      format("%-12s %-4s %-6s %3d %10lld %-5s %10.4f ms (%.4f..%.4f) %8.4f us/particle",
             scene.c_str(), r.solver.backend.c_str(), r.solver.precision.c_str(), r.solver.threads,
             static_cast<long long>(r.particles), r.state.c_str(), r.ms_median, r.ms_min, r.ms_max,
             r.ms_median * 1e3 / double(r.particles));
  out += format("  nbrs %.1f/%lld  %.0f B/particle ", r.measures.neighbors_mean,
                static_cast<long long>(r.measures.neighbors_max),
                double(r.solver.bytes) / double(r.particles));
  for (const StageTime& s : r.stages) out += format(" %s %.4f", s.name.c_str(), s.seconds * 1e3);
  return out;
}

}  // namespace

int command_bench(const BenchOptions& o) {
  Log log(false);
  CsvTable table(columns());
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
    if (!o.csv.empty() && is_stream(o.csv) == end) write_text_file(o.csv, table.text());
    if (!o.json.empty() && is_stream(o.json) == end) write_text_file(o.json, table.json());
  };
  std::vector<StageCosts> costs;
  const BenchSettings settings{o.warmup, o.updates, o.repeats};
  for (const auto& [base, dir] : scenes)
    for (const std::int64_t n : o.particles)
      for (const std::string& backend : o.backends)
        for (const std::string& precision : o.precisions) {
          // Threads are the CPU's alone.
          const std::vector<int> one{0};
          for (const int threads : backend == "cpu" ? o.threads : one) {
            Scene s = scaled_to(base, n, dir);
            s.backend = backend == "cuda" ? Backend::cuda : Backend::cpu;
            s.precision = precision == "double" ? Precision::dbl : Precision::single;
            s.threads = threads;
            const std::vector<BenchRow> rows = bench(s, dir, settings);
            if (o.calibrate) costs.push_back(calibration_of(rows.back()));
            for (const BenchRow& row : rows) {
              table.add(cells(s.name, row));
              log.result(line(s.name, row));
              store(false);
            }
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
