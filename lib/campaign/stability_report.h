// Results of the stability suite and of stability maps as text, tables and JUnit XML.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/stability.h"
#include "lib/campaign/stability_map.h"
#include "lib/io/table.h"

namespace pbf::campaign_module {

/// Two lines for users: the verdict, the requirements of the case, and what happened.
std::string stability_text(const StabilityRow& r);

/// One row per case.
Table stability_table(const std::vector<StabilityRow>& rows, const StabilityOptions& o);

/// One row per run of a map.
Table map_table(const std::vector<MapCell>& cells, const StabilityMap& map);

/// JUnit XML with a test case per case. seconds: of the whole suite, wall time.
std::string stability_junit(const std::vector<StabilityRow>& rows, const StabilityOptions& o,
                            double seconds);

}  // namespace pbf::campaign_module
