#include "lib/run/free_starts.h"

#include "lib/base/error.h"
#include "lib/program/emission.h"
#include "lib/program/free_bodies.h"
#include "lib/program/obstacles.h"
#include "lib/run/motion_warnings.h"
#include "lib/scene/free_start.h"

namespace pbf::run_module {

void require_free_starts(const Scene& s) {
  if (!has_free_bodies(s)) return;
  std::vector<NamedSolid> all;
  const std::vector<Solid<double>> solids = solids_of(s), casings = casings_of(s);
  for (std::size_t k = 0; k < solids.size(); ++k) all.push_back({named(s, k), solids[k]});
  for (std::size_t e = 0; e < casings.size(); ++e)
    all.push_back({"the casing of emitter " + s.emitters[e].name, casings[e]});
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const Obstacle& o = s.obstacles[k];
    if (!o.free) continue;
    std::vector<NamedSolid> others;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i != k) others.push_back(all[i]);
    std::string text = light_text(s, o);
    if (text.empty()) text = free_start_text(s, o, solids[k], others);
    if (text.empty()) continue;
    const obstacle_keys::SurfaceFile* file = o.surface_file();
    const std::string place = file && !file->place.text.empty() ? file->place.text + ": " : "";
    throw Error(ExitCode::bad_input,
                place + "obstacles[" + std::to_string(k) + "].free (" + o.name + "): " + text);
  }
}

}  // namespace pbf::run_module
