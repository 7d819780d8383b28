#include "lib/campaign/calibration.h"

#include <fmt/core.h>
#include <sys/file.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <tuple>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/io/csv.h"
#include "lib/io/table.h"
#include "lib/scene/number.h"

namespace pbf::campaign_module {
namespace {

const std::vector<std::string> kColumns{"backend",   "precision", "threads", "device",
                                        "particles", "stage",     "ms"};

/// Only one program at a time changes the folder. Does nothing on file systems without locks.
std::unique_ptr<std::FILE, int (*)(std::FILE*)> locked(const std::string& folder) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(folder.c_str(), "re"),
                                                       std::fclose);
  if (file) ::flock(::fileno(file.get()), LOCK_EX);
  return file;
}

/// The key of a measured state.
auto case_of(const StageCosts& c) {
  return std::tie(c.backend, c.precision, c.device, c.threads, c.particles);
}

/// Adds a line to its case; false if the line is invalid.
bool add_line(const std::vector<std::string>& cell, std::vector<StageCosts>& rows) {
  StageCosts row;
  std::int64_t threads = 0;
  double ms = 0;
  constexpr NumberError none = NumberError::none;
  if (read_number(cell[2], threads) != none || read_number(cell[4], row.particles) != none ||
      read_number(cell[6], ms) != none || threads < 0 || row.particles < 1 || ms < 0)
    return false;
  row.threads = int(threads);
  row.backend = cell[0], row.precision = cell[1], row.device = cell[3];
  const auto known = std::ranges::find(rows, case_of(row), case_of);
  StageCosts& into = known != rows.end() ? *known : rows.emplace_back(row);
  into.ms[cell[5]] = ms;
  return true;
}

/// A device's name without characters that end a cell of CSV.
std::string plain_name(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == ',' || c == '"'; }, ' ');
  return name;
}

/// Time of one pass at n particles, ms; linear interpolation of logarithms. `measured` is sorted by
/// particles and not empty.
double at_size(const std::vector<std::pair<double, double>>& measured, double n) {
  if (n <= measured.front().first) return measured.front().second * n / measured.front().first;
  for (std::size_t k = 1; k < measured.size(); ++k) {
    const auto& [n0, t0] = measured[k - 1];
    const auto& [n1, t1] = measured[k];
    if (n > n1 || !(t0 > 0) || !(t1 > 0)) continue;
    const double x = std::log(n / n0) / std::log(n1 / n0);
    return t0 * std::pow(t1 / t0, x);
  }
  return measured.back().second * n / measured.back().first;
}

}  // namespace

std::string calibration_path() {
  if (const char* file = std::getenv("PBF_CALIBRATION"); file && *file) return file;
  const char *data = std::getenv("XDG_DATA_HOME"), *home = std::getenv("HOME");
  if (data && *data) return std::string(data) + "/pbf/calibration.csv";
  if (home && *home) return std::string(home) + "/.local/share/pbf/calibration.csv";
  return "";
}

std::string calibration_scene_yaml() { return bench_scene_yaml() + "vorticity: {epsilon: 0.1}\n"; }

StageCosts calibration_of(const BenchRow& row) {
  StageCosts out;
  out.backend = row.solver.backend;
  out.precision = row.solver.precision;
  out.device = plain_name(row.solver.device);
  out.threads = row.solver.threads;
  out.particles = row.particles;
  for (const StageTime& s : row.stages) {
    const bool swept = s.name == "lambda" || s.name == "delta" || s.name == "density";
    out.ms[s.name] = s.seconds * 1e3 / (swept ? std::max(1, row.iterations) : 1);
  }
  return out;
}

std::vector<StageCosts> read_calibration(const std::string& path) {
  std::vector<StageCosts> rows;
  std::error_code error;  // e.g. a home folder without access for this user: no calibration
  if (!std::filesystem::exists(path, error)) return rows;
  const std::string remedy = "; remove the file and run pbf bench --calibrate again";
  const std::vector<CsvRow> lines = read_csv(path, remedy);
  if (!lines.empty() && lines[0].cells != kColumns)
    bad_input(lines[0].where, "the columns are " + joined(lines[0].cells, ",") + ", expected " +
                                  joined(kColumns, ",") + remedy);
  for (std::size_t k = 1; k < lines.size(); ++k)
    if (!add_line(lines[k].cells, rows))
      bad_input(lines[k].where, "not a line of a calibration" + remedy);
  return rows;
}

void store_calibration(const std::string& path, const std::vector<StageCosts>& rows) {
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(ExitCode::io, folder.string() + ": the folder of the calibration cannot be made: " +
                                  error.message());
  const auto lock = locked(folder.empty() ? "." : folder.string());
  std::vector<StageCosts> all = read_calibration(path);
  for (const StageCosts& row : rows)
    std::erase_if(all, [&](const StageCosts& old) { return case_of(old) == case_of(row); });
  all.insert(all.end(), rows.begin(), rows.end());
  Table table(kColumns);
  for (const StageCosts& row : all)
    for (const auto& [stage, ms] : row.ms)
      table.add({row.backend, row.precision, std::int64_t(row.threads), row.device, row.particles,
                 stage, ms});
  write_text_file(path, table.csv());
}

std::optional<TimeEstimate> estimate_time(const Plan& plan, const Scene& s,
                                          const std::vector<StageCosts>& rows, int threads,
                                          const std::string& cpu) {
  std::map<std::string, std::vector<std::pair<double, double>>> measured;  // stage: n, ms
  TimeEstimate out;
  for (const StageCosts& row : rows) {
    if (row.backend != word(s.backend) || row.precision != word(s.precision)) continue;
    if (about(s.backend).on_device ? !out.basis.empty() && row.device != out.basis
                                   : row.threads != threads || row.device != plain_name(cpu))
      continue;
    out.basis = row.device;
    for (const auto& [stage, ms] : row.ms) measured[stage].push_back({double(row.particles), ms});
  }
  if (measured.empty()) return std::nullopt;
  for (auto& [stage, sizes] : measured) std::ranges::sort(sizes);
  Scene reference;  // of the calibration: h = 2 d
  const double neighbors = rest_neighbors(s) / rest_neighbors(reference);
  std::map<std::string, int> passes;  // per stage; sort and gather are timed together
  for (const auto& [p, times] : count_passes(plan.program))
    passes[p->stage] = std::max(passes[p->stage], times);
  for (const auto& [stage, times] : passes) {
    // The calibration has no stage for density: lambda includes it and takes about as long.
    auto known = measured.find(stage == "density" && !measured.contains(stage) ? "lambda" : stage);
    if (known == measured.end()) continue;
    const bool of_pairs = stage != "predict" && stage != "grid";
    out.ms += times * at_size(known->second, double(plan.particles)) * (of_pairs ? neighbors : 1);
  }
  return out;
}

std::string RunTime::text() const {
  return (seconds < 0.05 ? "below 0.1 s"
                         : (least ? "at least " : "about ") + duration_text(seconds)) +
         " for the updates, without output; " + basis +
         (rough ? "; pbf bench --calibrate measures this machine" : "");
}

std::optional<RunTime> run_time(const Plan& plan, const Scene& s,
                                const std::optional<TimeEstimate>& measured, int threads) {
  const PlanTotals totals = plan_totals(plan, s);
  const auto updates = double(totals.updates + totals.settling);
  RunTime out;
  out.least = plan.finest_level > 0 || plan.repeats > 0;
  if (measured) {
    out.seconds = updates * measured->ms * 1e-3;
    out.basis = "by pbf bench --calibrate on " + measured->basis;
    return out;
  }
  if (about(s.backend).on_device) return std::nullopt;
  // Making the lists and the passes over them: nine in an update of 4 iterations.
  int passes = 1;
  for (const auto& [p, times] : count_passes(plan.program)) passes += p->over_pairs() ? times : 0;
  const double neighbors = rest_neighbors(s) / rest_neighbors(Scene{});
  out.rough = true;
  out.seconds = updates * double(plan.particles) * (passes / 9.0) * neighbors /
                (kRoughRate * std::max(1, threads));
  out.basis =
      fmt::format("a rule of thumb ({} particle-updates/s per CPU thread), maybe 3 times off",
                  si_number(kRoughRate));
  return out;
}

}  // namespace pbf::campaign_module
