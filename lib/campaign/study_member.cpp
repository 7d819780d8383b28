#include "lib/campaign/study_member.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/campaign/exact_projection.h"
#include "lib/io/run_layout.h"
#include "lib/program/motion.h"
#include "lib/program/schedule.h"
#include "lib/run/motion_files.h"
#include "lib/run/session.h"
#include "lib/run/start.h"

namespace pbf::inline campaign_module {
namespace {

/// s, by the clock of the study.
double seconds_of(const Session& session, const Study& study) {
  return study.cpu_clock ? session.seconds().cpu : session.seconds().wall;
}

/// Adds a row to the columns; whether the run may go on.
bool measure(Solver& solver, const Scene& scene, EnergyTrack& energy, WorkTrack& work,
             MemberResult& out) {
  LogRow row;
  row.measures = solver.measure();
  row.measures.work = work.until(row.measures);
  if (has_motion(scene)) solver.loads(Interval::ends), work.take(row.measures);
  energy.follow(row.measures);
  row.iterations = scene.solver.iterations;
  row.dt = scene.time.step;
  std::size_t k = 0;
  for (const auto& c : run_layout::log_columns()) {
    if (out.columns.size() <= k) {
      out.names.push_back(c.name);
      out.columns.emplace_back();
    }
    out.columns[k++].push_back(c.value(row));
  }
  const Diagnostics& m = row.measures;
  if (m.non_finite == 0 && m.outside == 0) return true;
  out.status = "diverged";
  out.message = format("at update %ld, t = %.4g s: %ld particles not finite, %ld outside", m.update,
                       m.time, m.non_finite, m.outside);
  return false;
}

/// Root mean square (and mean, and maximum) over several projections.
struct ProjectionSum {
  double mean = 0, squares = 0, max = 0;
  int n = 0, failed = 0;
  void add(const ProjectionError& e) {
    if (!e.converged) ++failed;
    mean += e.mean;
    squares += e.rms * e.rms;
    max = std::max(max, e.max);
    ++n;
  }
  void give(MemberResult& out) const {
    const bool known = n > 0 && failed == 0;
    out.projection_mean = known ? mean / n : NAN;
    out.projection_rms = known ? std::sqrt(squares / n) : NAN;
    out.projection_max = known ? max : NAN;
    if (failed) out.message = "the exact projection did not converge";
  }
};

}  // namespace

const std::vector<double>& MemberResult::series(const std::string& name) const {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return columns[k];
  throw Error(ExitCode::internal, "study: no column " + name + " in the log of a run");
}

double MemberResult::seconds_median() const {
  std::vector<double> all = ratios;
  all.push_back(1);
  std::sort(all.begin(), all.end());
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
  read_motions(scene, study.scene_dir);
  const Schedule schedule = make_schedule(scene);
  if (!study.projection.empty() && !scene.obstacles.empty())
    throw Error(ExitCode::bad_input,
                "projection: the exact projection does not know obstacles; remove one of them");
  MemberResult out;
  out.updates = schedule.updates;
  Start start = prepare(scene, study.scene_dir);
  const Plan& plan = start.plan;
  out.particles = plan.particles;
  // A short repeat is a tenth of the run, but no fewer than 20 updates.
  const std::int64_t early = std::min(out.updates, std::max<std::int64_t>(20, out.updates / 10));
  std::set<std::int64_t> moments;
  for (const double t : study.projection) moments.insert(std::llround(t / scene.time.step));

  double early_seconds = 0, timed = 0, booked = 0;
  std::int64_t early_timed = 0, timed_updates = 0, last = 0;
  ProjectionSum projection;
  std::optional<std::vector<double>> compared;  // of an update that is under way, its start
  bool stopped = false;
  {
    const std::unique_ptr<Solver> solver = solver_of(start);
    const SolverInfo info = solver->info();
    out.backend = info.backend, out.precision = info.precision, out.device = info.device;
    out.threads = info.threads;
    EnergyTrack energy;
    WorkTrack work;
    const auto next = [&](std::int64_t u) {
      if (compared) return u + 1;
      const auto moment = moments.upper_bound(u);
      return std::min({schedule.next_measure(u), u < early ? early : kNever,
                       moment == moments.end() ? kNever : *moment});
    };
    const auto at = [&](Session& session) {
      const std::int64_t u = session.update(), updates = u - last;
      const double seconds = seconds_of(session, study) - booked;
      if (compared) {
        projection.add(projection_error(*solver, scene, plan, *compared));
        compared.reset();
      } else {
        timed += seconds;
        timed_updates += updates;
        if (u <= early) early_seconds += seconds, early_timed += updates;
      }
      booked += seconds;
      last = u;
      if (schedule.measures(u)) {
        const bool good = measure(*solver, scene, energy, work, out);
        if (u > 0) progress(double(u) / double(out.updates));
        if (!good) return Now::stop;
      }
      stopped = u < out.updates && stop();
      if (u < out.updates && !stopped && moments.contains(u))
        compared = projection_start(*solver, scene, plan);
      return stopped ? Now::stop : Now::go_on;
    };
    Callback course(next, at);
    Session(*solver, {&course}).run(out.updates);
  }
  if (stopped) return std::nullopt;
  projection.give(out);
  // An update at which the projection was looked at is not timed; it took as long as the others.
  if (timed_updates > 0) out.seconds = timed * double(out.updates) / double(timed_updates);
  if (out.status != "finished") return out;
  for (int r = 1; r < study.repeats && early_timed > 0; ++r) {
    if (stop()) return std::nullopt;
    start = prepare(scene, study.scene_dir);
    const std::unique_ptr<Solver> solver = solver_of(start);
    Session again(*solver);
    again.run(early_timed);
    out.ratios.push_back(seconds_of(again, study) / early_seconds);
  }
  return out;
}

}  // namespace pbf::inline campaign_module
