// Units at the end of a column's name: H2_mm, F_kN, t_ms. One table for all tables that are read
// and written.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pbf::data_module {

struct UnitEnding {
  const char* ending;  ///< "_mm"
  const char* unit;    ///< "m", the unit of readings of that quantity
  double factor;       ///< of a number in the column, in that unit: 1e-3
};

/// All that are known; where one ends like another, the longer one counts.
const std::vector<UnitEnding>& unit_endings();

/// A column's name without its unit, and the unit; none if it has no known ending.
struct NamedUnit {
  std::string name;
  std::optional<UnitEnding> unit{};
};
NamedUnit named_unit(const std::string& column);

/// "_kg_m_s" for "kg m/s": how a column of readings in that unit ends; "" for a number alone ("1").
std::string unit_ending(const std::string& unit);

}  // namespace pbf::data_module
