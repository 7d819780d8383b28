#include "lib/program/dissipation.h"

#include <cmath>

#include "lib/program/hyperviscosity.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

bool dissipates(const Scene& s, Dissipation by) {
  switch (by) {
    case Dissipation::viscosity:
      return s.viscosity && s.viscosity->xsph != 0;
    case Dissipation::hyperviscosity:
      return hyperviscosity_of(s).every > 0;
    case Dissipation::confinement:
      return s.vorticity && s.vorticity->epsilon != 0;
    case Dissipation::damping:
      return s.solver.velocity_damping != 1;
  }
  return false;
}

std::vector<Dissipation> dissipations(const Scene& s) {
  using enum Dissipation;
  std::vector<Dissipation> all;
  for (const Dissipation by : {viscosity, hyperviscosity, confinement, damping})
    if (dissipates(s, by)) all.push_back(by);
  return all;
}

std::vector<double> dissipated(const std::vector<DissipationSum>& sums, const Scene& s,
                               const Plan& plan) {
  __extension__ typedef __int128 Wide;
  // J for a particle, of the unit of the sums.
  const double unit = plan.mass * s.h() * s.h() * plan.dissipation_unit / kDissipationUnits;
  const std::size_t causes = dissipations(s).size(), each = causes > 0 ? sums.size() / causes : 0;
  std::vector<double> out;
  for (std::size_t k = 0; k < causes; ++k) {
    Wide sum = 0;
    for (std::size_t i = k * each; i < (k + 1) * each; ++i)
      sum += Wide(sums[i].whole) * (Wide(1) << DissipationSum::bits) + sums[i].rest;
    out.push_back(unit * double(sum));
  }
  return out;
}

}  // namespace pbf::program_module
