// A stability map: runs a scene over a grid of two of its keys and classifies every run.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/stability.h"

namespace pbf::campaign_module {

/// stable: ran to the end below the limit on compression; degraded: ran above it; stopped: by the
/// guard.
enum class MapClass { stable, degraded, stopped };
constexpr const char* kMapClassNames[] = {"stable", "degraded", "stopped"};

struct StabilityMap {
  std::string scene;         ///< path
  std::string x_key, y_key;  ///< numeric keys of a scene; for a vector, its length is varied
  std::vector<double> x, y;
  std::vector<int> iterations{1, 2, 4, 8, 16};
  double limit = 0.01;  ///< mean compression of the settled part above which a run is degraded
  StabilityOptions run;
};

struct MapCell : Figures {
  double x = 0, y = 0;
  int iterations = 0;
  std::vector<std::string> settings;  ///< KEY=VALUE, the settings of the cell
  std::string scene;                  ///< its name
  MapClass verdict = MapClass::stable;
  double dt_hat = 0;        ///< relative_step(), lib/scene/auto_step.h
  std::string stopped_for;  ///< the guard's alarm
};

/// Values of an axis from text: V1,V2,... or FIRST:LAST:COUNT (a geometric sequence); empty: the
/// value of the scene times 1/4, 1/2, 1, 2, 4, 8. Throws Error(bad_input).
std::vector<double> map_values(const std::string& scene, const StabilityOptions& run,
                               const std::string& key, const std::string& text);

/// The cells of the grid, before they are run.
std::vector<MapCell> map_cells(const StabilityMap& map);

/// Runs one cell. If gravity changes, the simulated time scales with sqrt(h/g), so that all cells
/// cover the same dimensionless time. Empty if map.run.stop() ended it. Throws Error(bad_input) for
/// an invalid scene.
std::optional<MapCell> run_map_cell(const StabilityMap& map, MapCell cell);

/// One row per run of a map.
Table map_table(const std::vector<MapCell>& cells, const StabilityMap& map);

}  // namespace pbf::campaign_module
