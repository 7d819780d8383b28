// pbf stability: the suite of stiff and extreme cases, and maps over two scene keys.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <system_error>
#include <thread>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/machine.h"
#include "lib/base/text.h"
#include "lib/campaign/stability.h"
#include "lib/campaign/stability_map.h"
#include "lib/io/report.h"

namespace pbf::inline app_module {
namespace {

/// Calls work(k) for k below n on `jobs` threads; the first exception is thrown at the end.
template <class Work>
void in_parallel(std::size_t n, int jobs, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failed;
  std::mutex mutex;
  const auto loop = [&] {
    for (std::size_t k = next++; k < n; k = next++) {
      try {
        work(k);
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
  } catch (const std::system_error&) {  // no more to be had: those that run do the work
  }
  loop();
  for (std::thread& t : threads) t.join();
  if (failed) std::rethrow_exception(failed);
}

std::vector<StabilityCase> chosen(const StabilityCommandOptions& o) {
  std::vector<StabilityCase> all = read_stability_suite(o.suite), out;
  if (o.cases.empty()) return all;
  const auto add = [&](const StabilityCase& c) {
    for (const StabilityCase& have : out)
      if (have.name == c.name) return;
    out.push_back(c);
  };
  for (const std::string& name : o.cases) {
    bool found = false;
    for (const StabilityCase& c : all) {
      if (c.name != name && c.group != name) continue;
      found = true;
      // What a case is compared with runs too.
      for (const StabilityCase& other : all)
        if (other.name == c.must.like) add(other);
      add(c);
    }
    if (!found) {
      std::string names;
      for (const StabilityCase& c : all) names += " " + c.name;
      throw Error(ExitCode::bad_input,
                  "no case or group " + name + " in " + o.suite + "; the cases are" + names);
    }
  }
  return out;
}

std::string cut(const std::string& text, std::size_t width) {
  std::string line = text.substr(0, text.find('\n'));
  return line.size() <= width ? line : line.substr(0, width - 3) + "...";
}

std::string row_text(const StabilityRow& r) {
  // By how much: the criterion nearest to its limit, as a share of the limit.
  const std::string margin =
      r.used > 0 ? format("%3.0f %% of %s", 100 * r.used, r.tightest.c_str()) : std::string();
  return format("%-24s %-4s  %-16s must  %s\n%49s %s", r.name.c_str(), r.good ? "ok" : "FAIL",
                margin.c_str(), r.must.c_str(), "did ", cut(r.happened, 150).c_str());
}

void write_csv(const std::string& path, const std::vector<StabilityRow>& rows,
               const StabilityCommandOptions& o) {
  CsvTable table({"case",
                  "group",
                  "backend",
                  "precision",
                  "size",
                  "particles",
                  "updates",
                  "dt_hat",
                  "verdict",
                  "used",
                  "tightest",
                  "must",
                  "happened",
                  "speed_max",
                  "energy_rise",
                  "compression_mean",
                  "compression_max",
                  "nearest",
                  "slowed_down",
                  "seconds"});
  for (const StabilityRow& r : rows)
    table.add({r.name,
               r.group,
               o.backend,
               o.precision,
               std::string(o.reduced ? "reduced" : "full"),
               r.particles,
               r.updates,
               r.dt_hat,
               std::string(r.good ? "ok" : "fail"),
               r.used,
               r.tightest,
               r.must,
               r.happened,
               r.speed_max,
               r.energy_rise,
               r.compression_mean,
               r.compression_max,
               r.nearest,
               r.fast,
               r.seconds});
  write_text_file(path, table.text());
}

int run_suite(const StabilityCommandOptions& o, const StabilityOptions& run, int jobs) {
  Log log(o.quiet);
  const std::vector<StabilityCase> cases = chosen(o);
  check_output("--csv", o.csv);
  std::vector<StabilityRow> rows(cases.size());
  std::mutex mutex;
  std::size_t done = 0;
  const Stopwatch watch;
  in_parallel(cases.size(), jobs, [&](std::size_t k) {
    StabilityRow row = run_stability_case(cases[k], run);
    const std::lock_guard lock(mutex);
    rows[k] = std::move(row);
    log.transient(format("%zu of %zu cases, %.0f s: %s", ++done, cases.size(), watch.seconds(),
                         cases[k].name.c_str()));
  });
  judge_likeness(cases, rows);
  std::int64_t failed = 0;
  std::string group;
  for (const StabilityRow& r : rows) {
    if (r.group != group) log.result(r.group);
    group = r.group;
    log.result(row_text(r));
    failed += r.good ? 0 : 1;
  }
  log.result(format("%zu cases on %s %s%s: %lld failed, %.1f s", rows.size(), o.backend.c_str(),
                    o.precision.c_str(), o.reduced ? ", reduced" : "",
                    static_cast<long long>(failed), watch.seconds()));
  if (!o.csv.empty()) write_csv(o.csv, rows, o);
  return static_cast<int>(failed == 0 ? ExitCode::done : ExitCode::difference);
}

int run_map(const StabilityCommandOptions& o, const StabilityOptions& run, int jobs) {
  if (o.cases.size() > 1)
    throw Error(ExitCode::bad_input,
                "--map takes one scene file, not " + std::to_string(o.cases.size()));
  StabilityMap map;
  map.scene = o.cases.empty() ? "configs/stiff/pool.yaml" : o.cases[0];
  map.limit = o.limit;
  map.iterations = o.iterations;
  map.run = run;
  const std::size_t comma = o.map.find(',');
  if (comma == std::string::npos || o.map.find(',', comma + 1) != std::string::npos)
    throw Error(ExitCode::bad_input, "--map " + o.map + ": expected two keys, time.step,gravity");
  map.x_key = o.map.substr(0, comma);
  map.y_key = o.map.substr(comma + 1);
  map.x = map_values(map.scene, run.overrides, map.x_key, o.x);
  map.y = map_values(map.scene, run.overrides, map.y_key, o.y);
  check_output("--csv", o.csv);
  Log log(o.quiet);
  const std::vector<MapCell> grid = map_cells(map);
  std::vector<MapCell> cells(grid.size());
  std::mutex mutex;
  std::size_t done = 0;
  const Stopwatch watch;
  in_parallel(grid.size(), jobs, [&](std::size_t k) {
    MapCell cell = run_map_cell(map, grid[k]);
    const std::lock_guard lock(mutex);
    cells[k] = std::move(cell);
    log.transient(format("%zu of %zu runs, %.0f s", ++done, grid.size(), watch.seconds()));
  });
  CsvTable table({"scene", "backend", "precision", "x_key", "y_key", "x", "y", "iterations",
                  "class", "dt_hat", "compression_mean", "compression_max", "energy_rise",
                  "stopped_for"});
  std::int64_t count[3] = {0, 0, 0};
  for (const MapCell& c : cells) {
    ++count[static_cast<int>(c.verdict)];
    table.add({c.scene, o.backend, o.precision, map.x_key, map.y_key, c.x, c.y,
               std::int64_t(c.iterations), std::string(kMapClassNames[static_cast<int>(c.verdict)]),
               c.dt_hat, c.compression_mean, c.compression_max, c.energy_rise, c.stopped_for});
  }
  if (o.csv.empty())
    log.result(table.text());
  else
    write_text_file(o.csv, table.text());
  log.result(format("%zu runs: %lld stable, %lld degraded, %lld stopped, %.0f s", cells.size(),
                    static_cast<long long>(count[0]), static_cast<long long>(count[1]),
                    static_cast<long long>(count[2]), watch.seconds()));
  return 0;
}

}  // namespace

int command_stability(const StabilityCommandOptions& o) {
  const int jobs = o.jobs > 0 ? o.jobs : o.backend == "cpu" ? usable_threads() : 1;
  StabilityOptions run;
  run.reduced = o.reduced;
  run.backend = o.backend == "cuda" ? Backend::cuda : Backend::cpu;
  run.precision = o.precision == "double" ? Precision::dbl : Precision::single;
  run.threads = std::max(1, usable_threads() / jobs);
  run.overrides = o.overrides;
  return o.map.empty() ? run_suite(o, run, jobs) : run_map(o, run, jobs);
}

}  // namespace pbf::inline app_module
