// Converts a scene (SI units, its own axes) to Params (internal frame).
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/params.h"
#include "kernels/relative_motion.h"
#include "kernels/smoothing.h"
#include "lib/program/axes.h"
#include "lib/program/plan.h"
#include "lib/program/time_order.h"

namespace pbf::PBF_VARIANT {

/// Params::tensile_from for the exponent n: x^n is below 2^-60, less than the rounding of the
/// largest artificial pressure. Powers of much smaller x are subnormal numbers, for which
/// processors need 100 cycles and more. A power of two, which no C library rounds.
inline double least_tensile(int n) { return std::ldexp(1.0, -((60 + n - 1) / n)); }

template <class Real>
Params<Real> make_params(const Scene& scene, const Plan& plan) {
  const Scene s = in_internal_axes(scene, plan.axes);
  const double h = s.h();
  Params<Real> p;
  p.dimensions = s.dimensions;
  const double dt = s.time.step / plan.substeps;
  p.dt = Real(dt);
  p.inv_dt = Real(1 / dt);
  if (is_second_order(scene)) {
    p.back = Real(kDirectionsBack * dt);
    p.carry = Real(kCarriedPush);
  }
  p.gravity = {Real(s.gravity[0] / h), Real(s.gravity[1] / h), Real(s.gravity[2] / h)};
  p.damping = Real(plan.substeps == 1 ? s.solver.velocity_damping
                                      : std::pow(s.solver.velocity_damping, 1.0 / plan.substeps));
  // The guard's limit depends on the first measurement and is set later (StepOptions).
  if (s.solver.speed_limit > 0) {
    p.limit_speed = true;
    const double limit = s.solver.speed_limit / s.time.step;
    p.speed_squared = Real(limit * limit);
  }
  if (s.solver.iterations > 0) {  // one of two particles does at least half of their relative move
    const double speed = kResolvedWay / 2 / dt;
    p.passing_squared = Real(std::min(speed * speed, 1e30));
  }
  Box<Real>& b = p.boundary;
  b.extent = {Real((s.domain.max[0] - s.domain.min[0]) / h),
              Real((s.domain.max[1] - s.domain.min[1]) / h),
              Real((s.domain.max[2] - s.domain.min[2]) / h)};
  b.margin = Real(s.solver.wall_margin / h);
  for (int k = 0; k < 6; ++k)
    if (!s.domain.has_wall(k / 2, k % 2 == 1)) b.walls &= ~(1u << k);
  if (s.dimensions == 2) b.walls &= ~(y_min | y_max);
  b.adds_density = s.solver.boundary == BoundaryMode::density && b.walls != 0;
  b.scale = Real(plan.wall_scale);
  b.inv_range = Real(1 / plan.wall_range);
  p.cells_x = plan.cells[0];
  p.cells_y = plan.cells[1];
  p.cells_z = plan.cells[2];
  p.inv_cell = Real(1 / plan.cell_edge);
  const auto if_periodic = [&](int axis, Real value) {
    return s.domain.is_periodic(axis) ? value : Real(0);
  };
  p.period = {if_periodic(0, b.extent.x), if_periodic(1, b.extent.y), if_periodic(2, b.extent.z)};
  const Real cell = Real(plan.cell_edge);
  p.below = {if_periodic(0, cell), if_periodic(1, cell), if_periodic(2, cell)};
  p.vol = Real(plan.vol);
  p.two_sided = s.solver.constraint == ConstraintMode::two_sided;
  p.cfm = Real(s.solver.cfm);
  p.sor = Real(plan.sor);
  p.under_relax = !s.solver.sor;
  if (s.tensile) {
    p.tensile_k = Real(s.tensile->k);
    const double q = s.tensile->delta_q, t = 1 - q;
    // The norms cancel in W(q)/W(delta_q).
    p.tensile_scale =
        Real(1 / (s.solver.kernels == KernelMode::paper ? Poly6<double>::shape(q * q) : t * t * t));
    p.tensile_n = s.tensile->n;
    p.tensile_from = Real(least_tensile(p.tensile_n));
  }
  // Predictions take over a share of viscosities, too, and a share of that share.
  const double now = is_second_order(s) ? 1 - kCarriedPush : 1;
  p.xsph = Real(factor_of_sweep(s, plan.viscosity.sweeps) * now);
  p.hyperviscosity = Real(plan.hyperviscosity.factor * now);
  if (plan.hyperviscosity.every > 0) p.calm = Real(h / (gravity_of(s) * kCalmSpeed * kCalmSpeed));
  if (s.vorticity) p.vorticity = Real(s.vorticity->epsilon);
  p.update_dt = Real(s.time.step);
  return p;
}

/// A step without time: velocities are multiplied by `damping`, and iterations separate particles
/// without changing velocities. The constraint is one-sided: low density at a free surface is no
/// overlap, and attraction without artificial pressure would form clusters.
template <class Real>
Params<Real> without_time(Params<Real> p, double damping) {
  p.dt = p.inv_dt = p.back = p.carry = 0;
  p.damping = Real(damping);
  p.limit_speed = p.two_sided = false;
  p.speed_squared = p.passing_squared = Real(1e30);
  p.tensile_k = p.xsph = p.vorticity = 0;
  return p;
}

}  // namespace pbf::PBF_VARIANT
