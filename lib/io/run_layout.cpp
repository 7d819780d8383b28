#include "lib/io/run_layout.h"

namespace pbf::inline io_module::run_layout {

const std::vector<LogColumn>& log_columns() {
  using Row = const LogRow&;
  static const std::vector<LogColumn> columns = {
      {"time", "s", [](Row r) { return r.measures.time; }},
      {"dt", "s", [](Row r) { return r.dt; }},
      {"update", "1", nullptr, [](Row r) { return r.measures.update; }},
      {"iterations", "1", nullptr, [](Row r) { return std::int64_t{r.iterations}; }},
      {"compression_mean", "1", [](Row r) { return r.measures.compression_mean; }},
      {"compression_rms", "1", [](Row r) { return r.measures.compression_rms; }},
      {"compression_p99", "1", [](Row r) { return r.measures.compression_p99; }},
      {"compression_max", "1", [](Row r) { return r.measures.compression_max; }},
      {"share_above_1", "1", [](Row r) { return r.measures.share_above_1; }},
      {"share_above_10", "1", [](Row r) { return r.measures.share_above_10; }},
      {"height_kept", "1", [](Row r) { return r.measures.height_kept; }},
      {"hydrostatic_deviation", "1", [](Row r) { return r.measures.hydrostatic_deviation; }},
      {"kinetic_energy", "J", [](Row r) { return r.measures.kinetic_energy; }},
      {"potential_energy", "J", [](Row r) { return r.measures.potential_energy; }},
      {"energy", "J", [](Row r) { return r.measures.energy; }},
      {"energy_drift", "1", [](Row r) { return r.measures.energy_drift; }},
      {"energy_rise", "1", [](Row r) { return r.measures.energy_rise; }},
      {"momentum_x", "kg m/s", [](Row r) { return r.measures.momentum[0]; }},
      {"momentum_y", "kg m/s", [](Row r) { return r.measures.momentum[1]; }},
      {"momentum_z", "kg m/s", [](Row r) { return r.measures.momentum[2]; }},
      {"center_of_mass_x", "m", [](Row r) { return r.measures.center_of_mass[0]; }},
      {"center_of_mass_y", "m", [](Row r) { return r.measures.center_of_mass[1]; }},
      {"center_of_mass_z", "m", [](Row r) { return r.measures.center_of_mass[2]; }},
      {"speed_max", "m/s", [](Row r) { return r.measures.speed_max; }},
      {"front_x", "m", [](Row r) { return r.measures.front[0]; }},
      {"front_y", "m", [](Row r) { return r.measures.front[1]; }},
      {"front_z", "m", [](Row r) { return r.measures.front[2]; }},
      {"penetration", "m", [](Row r) { return r.measures.penetration; }},
      {"neighbors_mean", "1", [](Row r) { return r.measures.neighbors_mean; }},
      {"neighbors_max", "1", nullptr, [](Row r) { return r.measures.neighbors_max; }},
      {"outside", "1", nullptr, [](Row r) { return r.measures.outside; }},
      {"non_finite", "1", nullptr, [](Row r) { return r.measures.non_finite; }},
      {"fast", "1", nullptr, [](Row r) { return r.measures.fast; }},
      {"sweeps", "1", nullptr, [](Row r) { return r.measures.sweeps; }},
      {"unresolved", "1", nullptr, [](Row r) { return r.measures.unresolved; }},
      {"relative_way_max", "h", [](Row r) { return r.measures.relative_way_max; }},
  };
  return columns;
}

}  // namespace pbf::inline io_module::run_layout
