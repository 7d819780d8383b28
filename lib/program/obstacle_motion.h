// The motion of obstacles and of the tank as kernels take it: a table with a row for each step of a
// batch of steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/pass_move_solids.h"
#include "lib/program/feature.h"
#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "lib/program/plan.h"
#include "lib/program/posed_solids.h"

namespace pbf::PBF_VARIANT {

/// Number of steps in a table, or the number of steps of an update if that is larger.
constexpr int kMotionRows = 256;
inline std::int64_t motion_table_rows(const Plan& plan) {
  return std::max(kMotionRows, plan.substeps);
}

template <class Real>
struct MotionRows {
  std::vector<FrameStep<Real>> frames;
  std::vector<PoseStep<Real>> steps;
};

/// The velocity of a solid that moves from a to b in dt.
inline SolidVelocity velocity_between(const Solid<double>& a, const Solid<double>& b, double dt) {
  // `turn` rotates the body's axes from a to b; its axial vector is sin(angle) times the axis.
  double turn[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      turn[i][j] = 0;
      for (int k = 0; k < 3; ++k) turn[i][j] += b.turn[k][i] * a.turn[k][j];
    }
  const double axial[3] = {0.5 * (turn[2][1] - turn[1][2]), 0.5 * (turn[0][2] - turn[2][0]),
                           0.5 * (turn[1][0] - turn[0][1])};
  const double sine = std::sqrt(axial[0] * axial[0] + axial[1] * axial[1] + axial[2] * axial[2]);
  const double cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1);
  const double scale = sine > 1e-12 ? std::atan2(sine, cosine) / sine / dt : 1 / dt;
  const Vec3<double> spin = scale * Vec3<double>{axial[0], axial[1], axial[2]};
  const Vec3<double> middle = 0.5 * (a.center + b.center);
  const Vec3<double> go = (1 / dt) * (b.center - a.center) - cross(spin, middle);
  return {true, {go.x, go.y, go.z}, {spin.x, spin.y, spin.z}, {middle.x, middle.y, middle.z}};
}

/// Whether the body has no end, or goes on behind a wall of the domain.
inline bool is_endless(const Solid<double>& o) {
  const auto goes_on_somewhere = [](const auto& shape) {
    return goes_on(shape, Vec3<double>{1, 1, 1}) || goes_on(shape, Vec3<double>{-1, -1, -1});
  };
  return o.shape.with(goes_on_somewhere) || !is_bounded(o);
}
/// h: largest distance of a point of the body from its center, at most twice the domain's diagonal.
template <class Real>
double radius_of(const Solid<double>& o, const Box<Real>& walls) {
  const double all =
      std::hypot(double(walls.extent.x), double(walls.extent.y), double(walls.extent.z));
  return is_endless(o) ? 2 * all : size_of(o);
}
/// 2 sin(angle/2), for the angle by which a body turns from a to b.
inline double chord(const Solid<double>& a, const Solid<double>& b) {
  double squares = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) squares += std::pow(b.turn[i][k] - a.turn[i][k], 2);
  return std::sqrt(squares / 2);
}
/// h: upper bound of the displacement of a point of the body.
template <class Real>
double way_between(const Solid<double>& a, const Solid<double>& b, const Box<Real>& walls) {
  const Vec3<double> d = b.center - a.center;
  return std::sqrt(dot(d, d)) + chord(a, b) * radius_of(a, walls);
}

template <class Real>
Bounds<Real> wider(const Bounds<Real>& b, double by) {
  const Real more = Real(by);
  const Vec3<Real> v{more, more, more};
  return {b.low - v, b.high + v};
}
/// A solid before its step to `next`. Reach and bounds include its path: what it may meet is near.
template <class Real>
PosedSolid<Real> placed_before(const Solid<double>& now, const Solid<double>& next,
                               const Box<Real>& walls) {
  PosedSolid<Real> out = placed(now, walls);
  const double way = way_between(now, next, walls);
  out.reach = out.reach + Real(way);
  out.bounds = wider(out.bounds, way);
  return out;
}
/// All solids before a step that begins at `time` (s since the start).
template <class Real>
std::vector<PosedSolid<Real>> placed_at(const Scene& scene, const Plan& plan,
                                        const Box<Real>& walls, double time) {
  const std::vector<PosedSolid<Real>> casings = placed_solids(plan.casings, walls);
  const auto with_casings = [&](std::vector<PosedSolid<Real>> all) {
    all.insert(all.end(), casings.begin(), casings.end());
    return all;
  };
  if (!has_moving_obstacles(scene)) return with_casings(placed_solids(plan.solids, walls));
  const auto now = solids_of(scene, plan.axes, time);
  const auto next = solids_of(scene, plan.axes, time + scene.time.step / plan.substeps);
  std::vector<PosedSolid<Real>> all;
  for (std::size_t k = 0; k < now.size(); ++k) all.push_back(placed_before(now[k], next[k], walls));
  return with_casings(std::move(all));
}

/// The rows of these steps.
template <class Real>
MotionRows<Real> motion_rows(const Scene& scene, const Plan& plan, const Box<Real>& walls,
                             const StepRange& steps, int steps_per_update) {
  const auto [first, count, dt] = steps;
  MotionRows<Real> rows;
  const auto time = [&](std::int64_t step) { return double(step) * dt; };
  if (scene.tank_motion)
    for (int k = 0; k < count; ++k) {
      const FrameStep<double> f = frame_step(scene, plan.axes, time(first + k), dt);
      FrameStep<Real>& out = rows.frames.emplace_back();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          out.turn[i][j] = Real(f.turn[i][j]), out.pull[i][j] = Real(f.pull[i][j]);
      out.pivot = scaled<Real>(f.pivot, 1);
      out.push = scaled<Real>(f.push, 1);
    }
  if (!has_moving_obstacles(scene)) return rows;
  const auto at = [&](std::int64_t step) { return solids_of(scene, plan.axes, time(step)); };
  std::vector<Solid<double>> from = at(first), to = at(first + 1), next, begin, end = from;
  for (int k = 0; k < count; ++k, from = std::move(to), to = std::move(next)) {
    if (k % steps_per_update == 0) begin = std::move(end), end = at(first + k + steps_per_update);
    next = at(first + k + 2);
    for (std::size_t s = 0; s < to.size(); ++s) {
      if (!scene.obstacles[s].motion) continue;
      PoseStep<Real> step;
      step.solid = int(s);
      step.now = placed_before(to[s], next[s], walls);
      const PosedSolid<Real> was = placed(from[s], walls);
      step.before = was.solid;
      // Points of a turning body leave their chord by less than radius (1 - cos(angle/2)).
      const double turn = chord(from[s], to[s]), bulge = turn * turn / 4;
      step.now.bounds =
          wider(around_both(step.now.bounds, was.bounds), bulge * radius_of(from[s], walls));
      step.mean = velocity_between(begin[s], end[s], dt * steps_per_update);
      rows.steps.push_back(step);
    }
  }
  return rows;
}

/// The space that solids come near to during the run.
template <class Real>
struct RunBounds {
  Bounds<Real> all;
  std::vector<Bounds<Real>> moving;     ///< of each moving solid
  std::vector<Solid<double>> standing;  ///< solids at rest
};

template <class Real>
RunBounds<Real> bounds_of_run(const Scene& scene, const Plan& plan, const Box<Real>& walls) {
  RunBounds<Real> run;
  std::vector<PosedSolid<Real>> all = placed_at(scene, plan, walls, 0);
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (k < scene.obstacles.size() && scene.obstacles[k].motion)
      moving.push_back(k);
    else
      run.standing.push_back(k < plan.solids.size() ? plan.solids[k]
                                                    : plan.casings[k - plan.solids.size()]);
  if (!moving.empty()) {
    constexpr int samples = 512;
    // Upper bound of a displacement between two samples and in the step after the last one.
    const double fastest = fastest_obstacle(scene, 0, scene.time.end) / scene.h();
    const double way = 1.1 * fastest * (scene.time.end / samples + scene.time.step);
    for (int t = 1; t <= samples; ++t) {
      const auto now = placed_at(scene, plan, walls, scene.time.end * t / samples);
      for (const std::size_t k : moving) all[k].bounds = around_both(all[k].bounds, now[k].bounds);
    }
    for (const std::size_t k : moving) {
      all[k].bounds = wider(all[k].bounds, way);
      run.moving.push_back(all[k].bounds);
    }
  }
  run.all = bounds_of(all);
  if (has_free_bodies(scene)) {  // they may be anywhere
    const Real far(kEndless);
    run.all = {{-far, -far, -far}, {far, far, far}};
  }
  return run;
}

}  // namespace pbf::PBF_VARIANT
