#include "lib/scene/summary.h"

#include <algorithm>

#include "lib/scene/difference.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/suggest.h"
#include "lib/scene/surface.h"

namespace pbf::scene_module {
namespace {

class SummaryChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    if (s_.summary.empty() || !good(s_.summary, s_.dimensions, s_.gauges, s_.obstacles) ||
        !good(s_.domain.loads, s_.domain.open, s_.domain.periodic))
      return;
    if (!std::ranges::all_of(s_.gauges, [&](const Gauge& g) { return good(g.name, g.kind); }))
      return;
    std::vector<std::string> names;
    for (const SummaryColumn& c : summary_columns(s_)) names.push_back(c.name);
    for (const std::string& name : s_.summary) {
      if (std::ranges::find(names, name) != names.end()) continue;
      const std::string near = nearest_word(name, names);
      return add(s_.summary, "there is no column {}{}", name,
                 names.empty()  ? ": the scene has no gauges and records no loads (loads: true)"
                 : near.empty() ? "; there are " + first_of(names)
                                : "; did you mean " + near + "?");
    }
  }
};

}  // namespace

std::vector<SummaryColumn> summary_columns(const Scene& s) {
  using enum SummaryOf;
  std::vector<SummaryColumn> all;
  std::vector<int> axes{0, 1, 2};
  if (s.dimensions == 2) axes = {0, 2};
  for (const Gauge& g : s.gauges) {
    const GaugeColumn own = std::visit([](const auto& k) { return k.columns[0]; }, g.kind);
    for (const int axis : own.components > 1 ? axes : std::vector<int>{0}) {
      const std::string name =
          "gauge/" + g.name + (own.components > 1 ? std::string("/") + kAxes[axis] : "");
      const bool means = own.join == Join::mean;
      all.push_back({name + "/max", own.unit, "gauges/" + g.name, axis, largest, means});
      all.push_back({name + "/mean", own.unit, "gauges/" + g.name, axis, mean, means});
    }
  }
  for (const int surface : loaded_surfaces(s)) {
    const Obstacle* o = obstacle_of(s, surface);
    const std::string of = "load/" + (o ? o->name : kFaceNames[std::size_t(surface)]) + "/";
    for (const int axis : axes) {
      const std::string force = of + "force_" + kAxes[axis],
                        impulse = of + "impulse_" + kAxes[axis];
      all.push_back({force + "/max_20ms", "N", "log/" + impulse, 0, window_peak});
      all.push_back({force + "/mean", "N", "log/" + impulse, 0, window_mean});
      all.push_back({impulse, "N s", "log/" + impulse, 0, change});
    }
  }
  return all;
}

std::vector<SummaryColumn> wanted_summary_columns(const Scene& scene) {
  std::vector<SummaryColumn> all = summary_columns(scene);
  if (scene.summary.empty() && all.size() > kMostSummaryColumns) return {};
  if (!scene.summary.empty())
    std::erase_if(all, [&](const SummaryColumn& c) {
      return std::ranges::find(scene.summary, c.name) == scene.summary.end();
    });
  return all;
}

void check_summary(const PlacedScene& placed, Problems& problems) {
  SummaryChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
