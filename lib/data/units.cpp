#include "lib/data/units.h"

#include <cstring>

namespace pbf::data_module {

std::string unit_ending(const std::string& unit) {
  if (unit == "1" || unit.empty()) return "";
  std::string out = "_";
  for (const char c : unit)
    if (c == ' ' || c == '/')
      out += '_';
    else if (c != '^')
      out += c;
  return out;
}

const std::vector<UnitEnding>& unit_endings() {
  static const std::vector<UnitEnding> all{
      {"_s", "s", 1},          {"_ms", "s", 1e-3},     {"_m", "m", 1},
      {"_cm", "m", 1e-2},      {"_mm", "m", 1e-3},     {"_m_s", "m/s", 1},
      {"_cm_s", "m/s", 1e-2},  {"_mm_s", "m/s", 1e-3}, {"_Pa", "Pa", 1},
      {"_hPa", "Pa", 1e2},     {"_kPa", "Pa", 1e3},    {"_mbar", "Pa", 1e2},
      {"_bar", "Pa", 1e5},     {"_N", "N", 1},         {"_kN", "N", 1e3},
      {"_N_m", "N m", 1},      {"_N_s", "N s", 1},     {"_kg", "kg", 1},
      {"_g", "kg", 1e-3},      {"_kg_s", "kg/s", 1},   {"_kg_m_s", "kg m/s", 1},
      {"_kg_m3", "kg/m^3", 1}, {"_J", "J", 1},         {"_kJ", "J", 1e3},
      {"_rad_s", "rad/s", 1},  {"_deg", "deg", 1},
  };
  return all;
}

NamedUnit named_unit(const std::string& column) {
  const UnitEnding* best = nullptr;
  for (const UnitEnding& e : unit_endings())
    if (column.ends_with(e.ending) && column.size() > std::strlen(e.ending) &&
        (!best || std::strlen(e.ending) > std::strlen(best->ending)))
      best = &e;
  if (!best) return {column};
  return {column.substr(0, column.size() - std::strlen(best->ending)), *best};
}

}  // namespace pbf::data_module
