#include "lib/program/energy_at_rest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/boundary/solid_term.h"
#include "lib/program/axes.h"

namespace pbf::program_module {
namespace {

/// Cells of the sampling grid along an axis: 0.26 MB in all.
int cells_along(int dimensions) { return dimensions == 2 ? 180 : 32; }

/// The box in the internal frame, seen from its lowest corner: h.
struct Vessel {
  int dimensions = 3;
  double extent[3] = {1, 1, 1}, pull[3] = {0, 0, 0};  ///< pull: magnitude of gravity, m/s^2
  bool mirrored[3] = {false, false, false};           ///< gravity points to the upper face
  bool holds = true;                                  ///< all faces but those above are walls
};

Vessel vessel_of(const Scene& scene, const Plan& plan) {
  const Scene s = in_internal_axes(scene, plan.axes);
  Vessel v;
  v.dimensions = s.dimensions;
  for (int k = 0; k < 3; ++k) {
    const auto i = std::size_t(k);
    const double g = s.gravity[i];
    v.extent[k] = (s.domain.max[i] - s.domain.min[i]) / s.h();
    if (v.dimensions == 2 && k == 1) continue;
    if (s.domain.is_periodic(k)) continue;
    v.pull[k] = std::fabs(g);
    v.mirrored[k] = g > 0;
    const bool low_needed = g <= 0, high_needed = g >= 0;
    if ((low_needed && s.domain.is_open(k, false)) || (high_needed && s.domain.is_open(k, true)))
      v.holds = false;
  }
  return v;
}

struct Filled {
  double height = 0;  ///< h m/s^2, potential of the surface
  double energy = 0;  ///< h m/s^2, mean potential of the fluid
};

/// Fills `volume` (h^3) into the lowest free cells of a grid over `part` of the vessel, from its
/// lowest corner on.
Filled filled(const Vessel& v, const double (&part)[3], const std::vector<Solid<double>>& solids,
              double volume) {
  const bool flat = v.dimensions == 2;
  const int cells = cells_along(v.dimensions);
  const int n[3] = {cells, flat ? 1 : cells, cells};
  double edge[3];
  for (int k = 0; k < 3; ++k) edge[k] = part[k] / n[k];
  std::vector<double> free;
  free.reserve(std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]));
  for (int a = 0; a < n[0]; ++a)
    for (int b = 0; b < n[1]; ++b)
      for (int c = 0; c < n[2]; ++c) {
        const double up[3] = {(a + 0.5) * edge[0], (b + 0.5) * edge[1], (c + 0.5) * edge[2]};
        double at[3], potential = 0;
        for (int k = 0; k < 3; ++k) {
          at[k] = v.mirrored[k] ? v.extent[k] - up[k] : up[k];
          potential += v.pull[k] * up[k];
        }
        const Vec3<double> x{at[0], flat ? 0 : at[1], at[2]};
        const bool inside = std::any_of(solids.begin(), solids.end(), [&](const auto& o) {
          return (flat ? distance<2>(o, x) : distance<3>(o, x)) < 0;
        });
        if (!inside) free.push_back(potential);
      }
  std::sort(free.begin(), free.end());
  const double cell = edge[0] * edge[1] * edge[2];
  Filled out;
  double left = volume;
  for (const double potential : free) {
    const double share = std::min(left, cell);
    out.energy += share * potential / volume;
    out.height = potential;
    left -= share;
    if (!(left > 0)) break;
  }
  return out;
}

}  // namespace

double energy_at_rest(const Scene& scene, const Plan& plan) {
  const Vessel v = vessel_of(scene, plan);
  const double most = std::max({v.pull[0], v.pull[1], v.pull[2]});
  if (!v.holds || !(most > 0) || comes_and_goes(scene))
    return std::numeric_limits<double>::quiet_NaN();
  const double h = scene.h(), mass = plan.mass * double(plan.particles);
  const double volume = mass / (scene.fluid.rest_density * h * h * h);
  // First over the whole box, then over the part of it that is filled.
  double part[3] = {v.extent[0], v.extent[1], v.extent[2]};
  Filled all = filled(v, part, plan.solids, volume);
  for (int k = 0; k < 3; ++k) {
    const double cell = v.extent[k] / cells_along(v.dimensions);
    if (v.pull[k] > 0) part[k] = std::min(part[k], all.height / v.pull[k] + 2 * cell);
  }
  return mass * h * filled(v, part, plan.solids, volume).energy;
}

}  // namespace pbf::program_module
