// A stability map: runs a scene over a grid of two of its keys and classifies every run.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/stability.h"

namespace pbf::inline campaign_module {

/// stable: ran to the end below the limit on compression; degraded: above it; stopped: by the
/// guard.
enum class MapClass { stable, degraded, stopped };
constexpr const char* kMapClassNames[] = {"stable", "degraded", "stopped"};

struct StabilityMap {
  std::string scene;         ///< path
  std::string x_key, y_key;  ///< number keys of a scene; of a vector, its length is meant
  std::vector<double> x, y;
  std::vector<int> iterations{1, 2, 4, 8, 16};
  double limit = 0.01;  ///< mean compression of the settled part: above it a run is degraded
  StabilityOptions run;
};

struct MapCell : Figures {
  double x = 0, y = 0;
  int iterations = 0;
  std::vector<std::string> settings;  ///< that make the cell, KEY=VALUE
  std::string scene;                  ///< its name
  MapClass verdict = MapClass::stable;
  double dt_hat = 0;        ///< relative_step(), lib/scene/auto_step.h
  std::string stopped_for;  ///< the guard's alarm
};

/// Values of an axis from text: V1,V2,... or FIRST:LAST:COUNT (in equal ratios); empty: the scene's
/// own value times 1/4, 1/2, 1, 2, 4, 8. Throws Error(bad_input).
std::vector<double> map_values(const std::string& scene, const StabilityOptions& run,
                               const std::string& key, const std::string& text);

/// The grid, not run yet.
std::vector<MapCell> map_cells(const StabilityMap& map);

/// Runs one cell. Where gravity changes, the time simulated changes with sqrt(h/g), so that all
/// cells see the same dimensionless time. Empty when map.run.stop() said so. Throws
/// Error(bad_input) for a scene that is none.
std::optional<MapCell> run_map_cell(const StabilityMap& map, MapCell cell);

}  // namespace pbf::inline campaign_module
