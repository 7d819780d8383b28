#include "lib/program/diagnostics.h"

#include "lib/base/text.h"

namespace pbf::inline program_module {

const std::vector<Diagnostic>& diagnostics() {
  using M = const Diagnostics&;
  using enum Over;
  static const std::vector<Diagnostic> table = {
      {"compression_mean", "1", "sum of c/N", mean, true, [](M m) { return m.compression_mean; }},
      {"compression_rms", "1", "sqrt(sum of c^2/N)", rms, false,
       [](M m) { return m.compression_rms; }},
      {"compression_p99", "1", "c that 99 % of the particles are at or below", mean, true,
       [](M m) { return m.compression_p99; }},
      {"compression_max", "1", "largest c", max, true, [](M m) { return m.compression_max; }},
      {"share_above_1", "1", "particles with c > 1 %", mean, false,
       [](M m) { return m.share_above_1; }},
      {"share_above_10", "1", "particles with c > 10 %", mean, false,
       [](M m) { return m.share_above_10; }},
      {"height_kept", "1", "2 x height of the centre of mass above the floor / H0", mean, true,
       [](M m) { return m.height_kept; }},
      {"hydrostatic_deviation", "1", "RMS of (weight above z - rho0 g (H0 - z)) / (rho0 g H0)",
       mean, false, [](M m) { return m.hydrostatic_deviation; }},
      {"kinetic_energy", "J", "sum of m v^2/2", none, true, [](M m) { return m.kinetic_energy; }},
      {"potential_energy", "J", "-sum of m g.x, x from the domain's lower corner", none, false,
       [](M m) { return m.potential_energy; }},
      {"energy", "J", "E: kinetic and potential above the box's lowest corner", none, true,
       [](M m) { return m.energy; }},
      {"energy_drift", "1",
       "(E - W - E0)/E0; W: work of moving bodies, E0: E at the start (if none: the largest E)",
       last, true, [](M m) { return m.energy_drift; }},
      {"energy_rise", "1", "largest (E - W) - (lowest E - W before), over E0", last, true,
       [](M m) { return m.energy_rise; }},
      {"momentum_x", "kg m/s", "sum of m v", none, false, [](M m) { return m.momentum[0]; }},
      {"momentum_y", "kg m/s", "", none, false, [](M m) { return m.momentum[1]; }},
      {"momentum_z", "kg m/s", "", none, false, [](M m) { return m.momentum[2]; }},
      {"center_of_mass_x", "m", "sum of x/N", none, false, [](M m) { return m.center_of_mass[0]; }},
      {"center_of_mass_y", "m", "", none, false, [](M m) { return m.center_of_mass[1]; }},
      {"center_of_mass_z", "m", "", none, false, [](M m) { return m.center_of_mass[2]; }},
      {"speed_max", "m/s", "largest |v|", max, true, [](M m) { return m.speed_max; }},
      {"front_x", "m", "largest coordinate", none, true, [](M m) { return m.front[0]; }},
      {"front_y", "m", "", none, false, [](M m) { return m.front[1]; }},
      {"front_z", "m", "", none, false, [](M m) { return m.front[2]; }},
      {"penetration", "m", "farthest that a particle is behind its clamp at a wall", max, false,
       [](M m) { return m.penetration; }},
      {"neighbors_mean", "1", "particles closer than h, without the particle itself", mean, false,
       [](M m) { return m.neighbors_mean; }},
      {"neighbors_max", "1", "most of them", none, false, nullptr,
       [](M m) { return m.neighbors_max; }},
      {"outside", "1", "particles beyond a wall", none, false, nullptr,
       [](M m) { return m.outside; }},
      {"non_finite", "1", "particles with a NaN or infinity, in no other measure", none, false,
       nullptr, [](M m) { return m.non_finite; }},
      {"fast", "1", "particles x updates above solver.speed_limit or guard.speed so far", none,
       false, nullptr, [](M m) { return m.fast; }},
      {"iterations_done", "1", "over the constraints so far", none, false, nullptr,
       [](M m) { return m.iterations_done; }},
      {"unresolved", "1", "particles x steps that moved by more than 0.4 h past a neighbour so far",
       none, false, nullptr, [](M m) { return m.unresolved; }},
      {"relative_way_max", "h", "longest such way in a step", none, false,
       [](M m) { return m.relative_way_max; }},
  };
  return table;
}

std::string diagnostics_help() {
  std::string text;
  for (const Diagnostic& d : diagnostics()) {
    if (*d.help == '\0') continue;  // second and third component of a vector
    std::string name = d.name;
    if (name.ends_with("_x")) name += ", _y, _z";
    text += format("  %-24s %s [%s]\n", name.c_str(), d.help, d.unit);
  }
  return text;
}

}  // namespace pbf::inline program_module
