// What emitters and sinks report: readings, and lines of the plan.
#include <fmt/core.h>
#include <algorithm>

#include "lib/program/dissipation.h"
#include "lib/program/emission.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

std::int64_t emission_rows(const Plan& plan) { return std::max(kEmissionRows, plan.substeps); }

double emission_momentum_unit(const Scene& s, const Plan& plan) {
  return plan.mass * s.h() / s.time.step / kDissipationUnits;
}

std::vector<double> emission_readings(const std::vector<EmissionSum>& sums, const Scene& s,
                                      const Plan& plan, double time) {
  std::vector<double> out;
  const double energy = dissipation_unit(s, plan), momentum = emission_momentum_unit(s, plan);
  for (std::size_t e = 0; e < s.emitters.size(); ++e) {
    const auto n = double(plan.emission.nozzles[e].columns * plan.emission.released(e, time));
    out.insert(out.end(), {n, plan.mass * n, energy * units_in(sums[e].energy)});
  }
  for (std::size_t k = 0; k < s.sinks.size(); ++k) {
    const EmissionSum& sum = sums[s.emitters.size() + k];
    const auto n = double(sum.particles);
    const auto along = [&](int a) { return momentum * units_in(sum.momentum[a]); };
    const Double3 p = along_scene(plan.axes, {along(0), along(1), along(2)});
    out.insert(out.end(), {n, plan.mass * n, p[0], p[1], p[2], energy * units_in(sum.energy)});
  }
  return out;
}

double inflow_energy(const std::vector<EmissionSum>& sums, const Scene& s, const Plan& plan) {
  double sum = 0;
  for (std::size_t k = 0; k < sums.size(); ++k)
    sum += (k < s.emitters.size() ? 1 : -1) * units_in(sums[k].energy);
  return dissipation_unit(s, plan) * sum;
}

std::string emission_text(const Scene& s, const Plan& plan) {
  if (!comes_and_goes(s)) return "";
  const EmissionPlan& all = plan.emission;
  std::string out = fmt::format(
      "particles that come and go\n  {} at the start, {} of them in pipes; at most {}{}\n",
      plan.particles, plan.particles - all.first_id, plan.most_particles(),
      s.capacity > 0 ? " (capacity)" : "");
  const double end = s.time.end;
  for (std::size_t e = 0; e < all.nozzles.size(); ++e) {
    const PlannedNozzle& n = all.nozzles[e];
    const double fastest = fastest_of(s.emitters[e]);
    out += fmt::format(
        "  emitter {}: {} columns, {:.6g} m^2; at {:.6g} m/s {:.6g} kg/s, {:.6g} particles/s; {} "
        "particles leave it; its pipe is {:.4g} m deep\n",
        s.emitters[e].name, n.columns, n.area, fastest,
        fastest * double(n.columns) * plan.mass / s.fluid.spacing,
        fastest * double(n.columns) / s.fluid.spacing, n.columns * all.released(e, end),
        n.place.depth);
  }
  for (const Sink& k : s.sinks) {
    double volume = 1;
    for (std::size_t a = 0; a < 3; ++a) volume *= k.max[a] - k.min[a];
    out += fmt::format("  sink {}: {:.6g} m^3\n", k.name, volume);
  }
  return out;
}

}  // namespace pbf::program_module
