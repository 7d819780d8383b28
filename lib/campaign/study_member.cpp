#include "lib/campaign/study_member.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/base/error.h"
#include "lib/base/stage_clock.h"
#include "lib/base/text.h"
#include "lib/campaign/exact_projection.h"
#include "lib/exec/make_solver.h"
#include "lib/io/run_layout.h"
#include "lib/program/plan.h"
#include "lib/run/emit.h"
#include "lib/run/prestabilize.h"
#include "lib/run/start_neighbors.h"

namespace pbf::inline campaign_module {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Updates of a short repeat: a tenth of the run, but no fewer than 20.
std::int64_t short_updates(std::int64_t updates) {
  return std::min(updates, std::max<std::int64_t>(20, updates / 10));
}

Plan plan_of(const Scene& scene, const std::string& dir) {
  const std::int64_t n = count_particles(scene, dir);
  return make_plan(scene, n, start_neighbors(scene, dir, n));
}

/// One simulation with its clock.
class Simulation {
 public:
  Simulation(const Study& study, const StudyMember& member)
      : scene_(member.scene),
        cpu_clock_(study.cpu_clock),
        plan_(plan_of(scene_, study.scene_dir)),
        solver_((refuse_if_too_large(scene_, plan_),
                 start_solver(scene_, plan_, emit_particles(scene_, study.scene_dir)))) {}

  /// Seconds that n updates took, by the clock of the study.
  double step(std::int64_t n) {
    const Stopwatch watch;
    const double before = cpu_seconds();
    solver_->step(int(n));
    return cpu_clock_ ? cpu_seconds() - before : watch.seconds();
  }
  Solver& solver() { return *solver_; }
  const Plan& plan() const { return plan_; }

 private:
  /// Of all threads of this process.
  static double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  }

  const Scene& scene_;
  bool cpu_clock_;
  Plan plan_;
  std::unique_ptr<Solver> solver_;
};

/// Adds a row to the columns; whether the run may go on.
bool measure(Simulation& run, const Scene& scene, EnergyTrack& energy, MemberResult& out) {
  LogRow row;
  row.measures = run.solver().measure();
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
  const Measures& m = row.measures;
  if (m.non_finite == 0 && m.outside == 0) return true;
  out.status = "diverged";
  out.message = format("at update %lld, t = %.4g s: %lld particles not finite, %lld outside",
                       static_cast<long long>(m.update), m.time,
                       static_cast<long long>(m.non_finite), static_cast<long long>(m.outside));
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
    out.projection_mean = known ? mean / n : kNaN;
    out.projection_rms = known ? std::sqrt(squares / n) : kNaN;
    out.projection_max = known ? max : kNaN;
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
  const Scene& scene = member.scene;
  MemberResult out;
  out.updates = std::max<std::int64_t>(1, std::llround(scene.time.end / scene.time.step));
  const std::int64_t early = short_updates(out.updates);
  std::vector<std::int64_t> moments;
  for (const double t : study.projection)
    if (const auto u = std::llround(t / scene.time.step); u < out.updates) moments.push_back(u);
  std::sort(moments.begin(), moments.end());
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());

  double early_seconds = 0, timed = 0;
  std::int64_t early_timed = 0, timed_updates = 0;
  ProjectionSum projection;
  {
    Simulation run(study, member);
    EnergyTrack energy;
    const SolverInfo info = run.solver().info();
    out.backend = info.backend, out.precision = info.precision, out.device = info.device;
    out.threads = info.threads;
    out.particles = run.plan().particles;
    bool good = measure(run, scene, energy, out);
    for (std::int64_t u = 0; u < out.updates && good;) {
      if (stop()) return std::nullopt;
      if (std::binary_search(moments.begin(), moments.end(), u)) {
        projection.add(projection_error(run.solver(), scene, run.plan()));
        ++u;
      } else {
        std::int64_t to =
            std::min(out.updates, (u / scene.measure_every + 1) * scene.measure_every);
        if (u < early) to = std::min(to, early);
        for (const std::int64_t moment : moments)
          if (moment > u) to = std::min(to, moment);
        const double seconds = run.step(to - u);
        timed += seconds;
        timed_updates += to - u;
        if (to <= early) early_seconds += seconds, early_timed += to - u;
        u = to;
      }
      if (u % scene.measure_every == 0 || u == out.updates) {
        good = measure(run, scene, energy, out);
        progress(double(u) / double(out.updates));
      }
    }
  }
  projection.give(out);
  // An update at which the projection was looked at is not timed; it took as long as the others.
  if (timed_updates > 0) out.seconds = timed * double(out.updates) / double(timed_updates);
  if (out.status != "finished") return out;
  for (int r = 1; r < study.repeats && early_timed > 0; ++r) {
    if (stop()) return std::nullopt;
    Simulation again(study, member);
    out.ratios.push_back(again.step(early_timed) / early_seconds);
  }
  return out;
}

}  // namespace pbf::inline campaign_module
