#include "lib/run/prestabilize.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lib/program/time_levels.h"
#include "lib/run/guard.h"
#include "lib/scene/periodic.h"
#include "lib/scene/vector3.h"
#include "lib/solver/split_rows.h"

namespace pbf::run_module {
namespace {

constexpr int kRound = 8;              // steps of a round, at most
constexpr int kMostIterations = 2048;  // in total; but at least 32 steps
constexpr int kPatience = 64;          // iterations before giving up; at least 4 steps
constexpr double kHarmless = 1e-5;     // share of the energy scale
constexpr double kProgress = 0.75;     // largest useful ratio of the kicks after 2n and n steps
constexpr double kStill = 1e-6;        // h, a negligible move if all is at rest

/// Displacements from one call to the next, h. In the first one there are none.
class Displacements {
 public:
  Displacements(Solver& solver, const Scene& s) : solver_(solver), period_(periods(s)) {
    for (double& length : period_) length /= s.h();
    next();
  }
  Moves next() {
    if (SplitRows* split = solver_.split()) return split->moves();
    std::vector<double> to = solver_.state(StateOf::positions).position;
    Moves moves;
    if (!from_.empty()) moves.add(from_, to, period_);
    from_ = std::move(to);
    return moves;
  }

 private:
  Solver& solver_;
  Double3 period_;
  std::vector<double> from_;
};

/// The kick after a number of steps.
struct Point {
  int steps;
  double kick;
};

/// Whether the second half of the steps achieved little: there is no room to relieve the rest.
bool hopeless(const std::vector<Point>& course) {
  const Point now = course.back();
  const auto half = std::find_if(course.rbegin(), course.rend(),
                                 [&](const Point& p) { return 2 * p.steps <= now.steps; });
  return half != course.rend() && !(now.kick < kProgress * half->kick);
}

}  // namespace

Prestabilized prestabilize(Solver& solver, const Scene& s, const Plan& plan,
                           const std::function<void(const std::string&)>& progress) {
  Prestabilized p;
  if (!s.solver.prestabilize || s.solver.iterations == 0 || s.settle) return p;
  p.before = solver.diagnose();
  const double dt = std::ldexp(s.time.step / plan.substeps, -finest_level(s));
  const double speed = s.h() / dt;  // m/s, for a move by h
  // Energy in J for a sum of squared displacements in h^2.
  const auto energy = [&](double squares) { return 0.5 * plan.mass * squares * speed * speed; };
  const double n = double(plan.particles), noise = n * std::pow(position_rounding(s), 2);
  const double scale = energy_scale(p.before, s, plan);
  p.harmless = scale > 0 ? std::max(kHarmless * scale, energy(noise))
                         : energy(std::max(noise, n * kStill * kStill));
  // A step moves particles by about c h, with c the compression; twice that is an upper estimate.
  p.kick = energy(n * std::pow(2 * p.before.compression_rms, 2));
  if (p.relieved() || p.before.non_finite > 0) return p;
  Displacements positions(solver, s);
  std::vector<Point> course;
  const std::int64_t iterations = std::int64_t(s.solver.iterations) * plan.substeps;
  const std::int64_t most = std::max<std::int64_t>(kMostIterations / iterations, 32);
  const std::int64_t patience = std::max<std::int64_t>(kPatience / iterations, 4);
  for (int round = 1; p.steps < most; round = std::min(p.steps, kRound)) {
    solver.step(round, {.without_time = 1.0});
    p.steps += round;
    const Moves moves = positions.next();
    p.moved += moves.farthest * s.fluid.smoothing_ratio;
    p.kick = energy(moves.squares / (round * round));  // for the mean step of the round
    if (progress)
      progress(
          fmt::format("start: {} steps without time; one more would give the particles {:.2g} J, "
                      "{:.2g} J do no harm",
                      p.steps, p.kick, p.harmless));
    course.push_back({p.steps, p.kick});
    if (p.relieved() || (p.steps >= patience && hopeless(course))) break;
  }
  if (s.domain.open.empty())  // the sum over rounds may exceed any real displacement
    p.moved = std::min(p.moved, length(s.domain.max - s.domain.min) / s.fluid.spacing);
  p.after = solver.diagnose();
  return p;
}

std::string prestabilized_text(const Prestabilized& p) {
  if (p.steps == 0) return {};
  // At edges of bodies a step relieves the worst particles and compresses their neighbors.
  const Diagnostics &a = p.before, &b = p.after;
  const bool spread =
      b.compression_mean > a.compression_mean && b.compression_max < a.compression_max;
  std::string text = fmt::format(
      "start: compression mean {:.3g} %, largest {:.3g} %; after {} step{} without time "
      "(solver.prestabilize) mean {:.3g} %{}, largest {:.3g} %; no particle has moved by more than "
      "{:.2g} spacings",
      100 * a.compression_mean, 100 * a.compression_max, p.steps, p.steps == 1 ? "" : "s",
      100 * b.compression_mean, spread ? " (spread over more particles now)" : "",
      100 * b.compression_max, p.moved);
  if (!p.relieved())
    text += fmt::format(
        ". What is left did not go in these steps; one more would give them {:.2g} J", p.kick);
  if (!p.relieved() && b.compression_mean > 0.01)
    text += ": is there room for all of them? Is fluid.mass as meant?";
  return text;
}

}  // namespace pbf::run_module
