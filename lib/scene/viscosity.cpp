#include "lib/scene/viscosity.h"

#include <cmath>

#include "kernels/boundary/solid_share.h"

namespace pbf::scene_module {
namespace {

struct Moments {
  double second = 0;  ///< sum of vol W z^2 over the lattice
  double behind = 0;  ///< sum of vol W z over the layers behind a wall at d/2
  double first = 0;   ///< F(d/2), that of the half space
};

/// vol: weight of a particle; 0: that of the rest lattice.
template <Smoothing S>
Moments moments_of(double ratio, double vol) {
  const int reach = int(std::ceil(ratio)), reach_y = dimensions_of(S) == 2 ? 0 : reach;
  Moments m;
  double sum = 0;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach_y; y <= reach_y; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const double q_squared = (x * x + y * y + z * z) / (ratio * ratio), height = z / ratio;
        const double w =
            density_norm<double, S>() *
            density_shape<double, S>(q_squared, Spiky<double>::t(std::sqrt(q_squared)));
        sum += w;
        m.second += w * height * height;
        if (z > 0) m.behind += w * height;
      }
  const double weight = vol > 0 ? vol : 1 / sum;
  m.second *= weight, m.behind *= weight;
  m.first = first_moment<S>(0.5 / ratio);
  return m;
}

Moments moments_of(const Scene& s) {
  const double ratio = s.fluid.smoothing_ratio;
  double vol = 0;
  if (s.fluid.mass) {
    const double h = s.h(), third = s.dimensions == 2 ? s.domain.max[1] - s.domain.min[1] : h;
    vol = *s.fluid.mass / (s.fluid.rest_density * h * h * third);
  }
  const bool paper = s.solver.kernels == KernelMode::paper;
  if (s.dimensions == 2)
    return paper ? moments_of<Smoothing::paper_2d>(ratio, vol)
                 : moments_of<Smoothing::consistent_2d>(ratio, vol);
  return paper ? moments_of<Smoothing::paper>(ratio, vol)
               : moments_of<Smoothing::consistent>(ratio, vol);
}

/// The factor of all sweeps of an update together.
double factor_of_update(const Scene& s, double nu) {
  return nu * s.time.step / (viscous_moment(s) * s.h() * s.h());
}

}  // namespace

double viscous_moment(const Scene& s) { return 0.5 * moments_of(s).second; }

double friction_scale(const Scene& s) {
  const Moments m = moments_of(s);
  return m.behind / m.first;
}

ViscousSweeps viscous_sweeps(const Scene& s) {
  if (!s.viscosity) return {};
  if (!s.viscosity->kinematic) return {s.viscosity->xsph != 0, s.viscosity->xsph};
  const double all = factor_of_update(s, *s.viscosity->kinematic);
  const double sweeps = std::ceil(all / most_of_sweep(has_friction(s)) - 1e-9);
  const int n = int(std::clamp(sweeps, 1.0, double(kMostSweeps)));
  return {n, all / n};
}

double factor_of_sweep(const Scene& s, int sweeps) {
  if (!s.viscosity || sweeps == 0) return 0;
  if (!s.viscosity->kinematic) return s.viscosity->xsph;
  return factor_of_update(s, *s.viscosity->kinematic) / sweeps;
}

double kinematic_viscosity(const Scene& s) {
  if (!s.viscosity) return 0;
  if (s.viscosity->kinematic) return *s.viscosity->kinematic;
  return s.viscosity->xsph / factor_of_update(s, 1);
}

double longest_viscous_step(const Scene& s) {
  const double most = kMostSweeps * most_of_sweep(has_friction(s));
  return most * s.time.step / factor_of_update(s, *s.viscosity->kinematic);
}

}  // namespace pbf::scene_module
