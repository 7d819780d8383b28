#include "lib/run/settle.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "lib/base/error.h"
#include "lib/exec/ranks/world.h"
#include "lib/program/schedule.h"
#include "lib/program/settling.h"
#include "lib/run/guard.h"
#include "lib/run/prestabilize.h"
#include "lib/run/session.h"
#include "lib/scene/periodic.h"
#include "lib/scene/vector3.h"
#include "lib/solver/split_rows.h"

namespace pbf::run_module {
namespace {

/// False: stopped before the end.
bool advance(Solver& solver, std::int64_t updates,
             const std::function<void(const std::string&)>& progress,
             const std::function<bool()>& stop) {
  Callback watching(
      [](std::int64_t) { return kEveryCall; },
      [&](Session& session) {
        if (progress)
          progress(fmt::format("start: settles, update {} of {}", session.update(), updates));
        return stop && stop() ? Next::stop : Next::go_on;
      });
  Session(solver, {&watching}, 0.25).run(updates);
  return solver.updates() == updates;
}

/// Puts the particles where they have come to, and returns the farthest way, m.
double move_to(const std::vector<double>& position, const Scene& s, std::vector<Double3>& to) {
  double farthest = 0;
  const Double3 period = periods(s);
  for (std::size_t i = 0; i < to.size(); ++i) {
    Double3 x;
    for (std::size_t a = 0; a < 3; ++a) x[a] = s.origin()[a] + s.h() * position[3 * i + a];
    if (s.domain.open.empty())  // rounding may have put it outside
      for (std::size_t a = 0; a < 3; ++a) x[a] = std::clamp(x[a], s.domain.min[a], s.domain.max[a]);
    Double3 way = x - to[i];
    for (std::size_t a = 0; a < 3; ++a) way[a] = shortest(way[a], period[a]);
    farthest = std::max(farthest, length(way));
    to[i] = x;
  }
  return farthest;
}

/// Particles at rest, in place of those of `start`.
Start resting(const Start& start) {
  Start rest;
  rest.particles = start.particles;
  std::ranges::fill(rest.particles.velocity, Double3{});
  if (!start.pieces) return rest;
  rest.pieces = [all = start.pieces](const TakeParticles& take) {
    all([&](std::int64_t first, Particles&& piece) {
      std::ranges::fill(piece.velocity, Double3{});
      take(first, std::move(piece));
    });
  };
  return rest;
}
/// The particles of the start where the solver has left them, and their farthest way, m.
double move_all(Start& start, std::unique_ptr<Solver> solver) {
  if (!start.pieces)
    return move_to(solver->state(StateOf::positions).position, start.scene(),
                   start.particles.position);
  solver->split()->moves();
  solver.reset();  // leaves its positions on the ranks
  const auto move = [n = start.plan.particles, s = std::make_shared<const Scene>(start.scene())](
                        std::int64_t first, Particles& piece) {
    return move_to(left_positions(n, first, first + std::int64_t(piece.size())), *s,
                   piece.position);
  };
  double farthest = 0;
  start.pieces([&](std::int64_t first, Particles&& piece) {
    farthest = std::max(farthest, move(first, piece));
  });
  start.pieces = [all = start.pieces, move](const TakeParticles& take) {
    all([&](std::int64_t first, Particles&& piece) {
      move(first, piece);
      take(first, std::move(piece));
    });
  };
  return farthest;
}

}  // namespace

bool settle(Start& start, const std::function<void(const std::string&)>& progress,
            const std::function<bool()>& stop) {
  const Scene& scene = start.scene();
  if (!scene.settle) return true;
  const Scene s = settling_scene(scene);
  const Plan plan = make_plan(s, start.plan.particles, start.plan.start);
  Start rest = resting(start);
  std::unique_ptr<Solver> solver = new_solver(rest, s, plan);
  prestabilize(*solver, s, plan, progress);
  const double scale = energy_scale(solver->diagnose(), s, plan);
  const std::int64_t updates = make_schedule(s).updates;
  if (!advance(*solver, updates, progress, stop)) return false;
  const Diagnostics m = solver->diagnose();
  if (m.non_finite > 0)
    throw Error(ExitCode::guard,
                fmt::format("settle: {} particles are not finite after {:g} s before time 0; does "
                            "the scene run without settle? Give a shorter time.step",
                            m.non_finite, s.time.end));
  const double way = move_all(start, std::move(solver));
  start.notes.push_back(fmt::format(
      "start: settled for {:g} s before time 0, in {} updates; its particles moved by up to {:.3g} "
      "m, and had {:.2g} J of kinetic energy and a mean compression of {:.2g} % at the end",
      s.time.end, updates, way, m.kinetic_energy, 100 * m.compression_mean));
  if (scale > 0 && m.kinetic_energy > kSettled * scale)
    start.warnings.push_back(
        {"unsettled",
         fmt::format(
             "the start has not come to rest: after {:g} s of settle.duration its kinetic energy "
             "is {:.2g} % of its energy; give a longer settle.duration",
             s.time.end, 100 * m.kinetic_energy / scale)});
  return true;
}

}  // namespace pbf::run_module
