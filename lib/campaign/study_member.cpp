#include "lib/campaign/study.h"

#include <fmt/core.h>
#include <algorithm>

#include "lib/base/error.h"
#include "lib/io/run_layout.h"
#include "lib/program/motion.h"
#include "lib/program/schedule.h"
#include "lib/run/linked_files.h"
#include "lib/run/session.h"
#include "lib/run/start.h"

namespace pbf::campaign_module {
namespace {

/// Seconds by the clock that the study selects.
double seconds_of(const Session& session, const Study& study) {
  return study.cpu_clock ? session.seconds().cpu : session.seconds().wall;
}

/// Adds a row to the columns; returns whether the run may continue. `regular`: a longer run would
/// measure here, too.
bool measure(Solver& solver, const Scene& scene, const Plan& plan, bool regular,
             EnergyTrack& energy, WorkTrack& work, MemberResult& out) {
  if (!scene.gauges.empty()) {
    const std::vector<double> numbers =
        solver.readings(Series::gauges, regular ? Interval::ends : Interval::goes_on);
    for_each_number(plan.columns, Series::gauges,
                    [&](const ReadingColumn& c, int component, std::size_t k) {
                      out.log[stored_column(c, component)].push_back(numbers.at(k));
                    });
  }
  LogRow row;
  row.measures = solver.diagnose();
  row.measures.work = work.until(row.measures);
  if (const std::vector<std::string> loaded = loaded_names(scene);
      has_work(scene) || !loaded.empty()) {
    const std::vector<double> numbers =
        solver.readings(Series::measures, regular ? Interval::ends : Interval::goes_on);
    if (regular) work.take(row.measures);
    for_each_number(plan.columns, Series::measures,
                    [&](const ReadingColumn& c, int component, std::size_t k) {
                      if (c.kind == std::string_view("load"))
                        out.log[stored_column(c, component)].push_back(numbers.at(k));
                    });
  }
  energy.follow(row.measures);
  row.iterations = scene.solver.iterations;
  row.dt = scene.time.step;
  for (const auto& c : run_layout::log_columns()) out.log[c.name].push_back(c.value(row));
  if (has_work(scene)) out.log["work"].push_back(row.measures.work);
  const Diagnostics& m = row.measures;
  if (m.non_finite == 0 && m.outside == 0) return true;
  out.status = "diverged";
  out.message = fmt::format("at update {}, t = {:.4g} s: {} particles not finite, {} outside",
                            m.update, m.time, m.non_finite, m.outside);
  return false;
}

}  // namespace

std::vector<ReadingColumn> stored_readings(const Scene& scene) {
  std::vector<ReadingColumn> all;
  for (const Gauge& g : scene.gauges)
    std::visit(
        [&](const auto& kind) {
          for (const GaugeColumn& c : kind.columns)
            all.push_back({kind.word, g.name, c.name, c.unit, "", c.join, c.components});
        },
        g.kind);
  for (const std::string& of : loaded_names(scene)) {
    const std::vector<ReadingColumn> columns = load_columns(of, 0, 0);
    all.insert(all.end(), columns.begin(), columns.end());
  }
  return all;
}

std::string stored_column(const ReadingColumn& c, int component) {
  if (c.series != Series::gauges) return run_layout::further_column(c, component);
  const std::string number = number_name(c, component);
  return "gauge/" + c.of + (number.empty() ? "" : "/" + number);
}

std::vector<FurtherColumn> further_columns(const Scene& scene) {
  std::vector<FurtherColumn> all;
  for (const ReadingColumn& c : stored_readings(scene))
    for (int k = 0; k < c.components; ++k) all.push_back({stored_column(c, k), c.unit});
  if (has_work(scene)) all.push_back({"work", "J"});
  return all;
}

const std::vector<double>& MemberResult::series(const std::string& name) const {
  if (const auto column = log.find(name); column != log.end()) return column->second;
  throw Error(ExitCode::internal, "study: no column " + name + " in the log of a run");
}

double MemberResult::seconds_median() const {
  std::vector<double> all = ratios;
  all.push_back(1);
  std::ranges::sort(all);
  const std::size_t n = all.size();
  return seconds * 0.5 * (all[(n - 1) / 2] + all[n / 2]);
}

double MemberResult::seconds_spread() const {
  double low = 1, high = 1;
  for (const double r : ratios) low = std::min(low, r), high = std::max(high, r);
  return seconds * (high - low);
}

std::optional<MemberResult> run_member(const Study& study, const StudyMember& member,
                                       const std::function<bool()>& stop,
                                       const std::function<void(double)>& progress) {
  Scene scene = member.scene;
  read_linked_files(scene, study.scene_dir);
  const Schedule schedule = make_schedule(scene);
  MemberResult out;
  out.updates = schedule.updates;
  Start start = prepare(scene, study.scene_dir);
  const std::string files = files_text(start.particles.files);
  out.particles = start.plan.particles;
  // A short repeat is a tenth of the run, but no fewer than 20 updates.
  const std::int64_t early = std::min(out.updates, std::max<std::int64_t>(20, out.updates / 10));
  double early_seconds = 0;
  bool stopped = false;
  {
    const std::unique_ptr<Solver> solver = solver_of(start);
    const SolverInfo info = solver->info();
    out.backend = info.backend, out.precision = info.precision, out.device = info.device;
    out.threads = info.threads;
    EnergyTrack energy;
    WorkTrack work;
    const auto next = [&](std::int64_t u) {
      return std::min(schedule.next_measure(u), u < early ? early : kNever);
    };
    const auto at = [&](Session& session) {
      const std::int64_t u = session.update();
      const double seconds = seconds_of(session, study);
      if (u > 0) out.seconds = seconds * double(out.updates) / double(u);
      if (u <= early) early_seconds = seconds;
      if (schedule.measures(u)) {
        const bool regular = u % schedule.measure_every == 0;
        const bool good = measure(*solver, scene, start.plan, regular, energy, work, out);
        if (u > 0) progress(double(u) / double(out.updates));
        if (!good) return Next::stop;
      }
      stopped = u < out.updates && stop();
      return stopped ? Next::stop : Next::go_on;
    };
    Callback course(next, at);
    Session(*solver, {&course}).run(out.updates);
  }
  if (stopped) return std::nullopt;
  if (out.status != "finished") return out;
  for (int r = 1; r < study.repeats && early > 0; ++r) {
    if (stop()) return std::nullopt;
    start = prepare(scene, study.scene_dir, {.fits = false});  // it did
    const std::string changed = files_difference(files, start.particles.files);
    if (!changed.empty()) bad_input("study", "while it ran, " + changed);
    const std::unique_ptr<Solver> solver = solver_of(start);
    Session again(*solver);
    again.run(early);
    out.ratios.push_back(seconds_of(again, study) / early_seconds);
  }
  return out;
}

}  // namespace pbf::campaign_module
