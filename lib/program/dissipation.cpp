#include "lib/program/dissipation.h"

#include <iterator>

#include "lib/program/hyperviscosity.h"
#include "lib/program/plan.h"
#include "lib/scene/viscosity.h"

namespace pbf::program_module {

bool dissipates(const Scene& s, Dissipation by) {
  switch (by) {
    case Dissipation::viscosity:
      return viscous_sweeps(s).sweeps > 0;
    case Dissipation::friction:
      return viscous_sweeps(s).sweeps > 0 && has_friction(s);
    case Dissipation::hyperviscosity:
      return hyperviscosity_of(s).every > 0;
    case Dissipation::confinement:
      return s.vorticity && s.vorticity->epsilon != 0;
    case Dissipation::damping:
      return s.solver.velocity_damping != 1;
    case Dissipation::sponge:
      return !s.damping.empty();
  }
  return false;
}

std::vector<Dissipation> dissipations(const Scene& s) {
  std::vector<Dissipation> all;
  for (int k = 0; k < int(std::size(kDissipationNames)); ++k)
    if (const auto by = static_cast<Dissipation>(k); dissipates(s, by)) all.push_back(by);
  return all;
}

double dissipation_unit(const Scene& s, const Plan& plan) {
  return plan.mass * s.h() * s.h() * plan.dissipation_unit / kDissipationUnits;
}

double units_in(std::span<const DissipationSum> sums) {
  __extension__ typedef __int128 Wide;
  Wide all = 0;
  for (const DissipationSum& s : sums)
    all += Wide(s.whole) * (Wide(1) << DissipationSum::bits) + s.rest;
  return double(all);
}

std::vector<double> dissipated(const std::vector<DissipationSum>& sums, const Scene& s,
                               const Plan& plan) {
  const double unit = dissipation_unit(s, plan);
  const std::size_t causes = dissipations(s).size(), each = causes > 0 ? sums.size() / causes : 0;
  std::vector<double> out;
  for (std::size_t k = 0; k < causes; ++k)
    out.push_back(unit * units_in(std::span(sums).subspan(k * each, each)));
  return out;
}

}  // namespace pbf::program_module
