#include "lib/program/gauges.h"

namespace pbf::inline program_module {
namespace {

/// Adds the gauge if it is of this kind.
template <class Kind>
void add_gauge(GaugePlan& plan, const Gauge& g, GaugeFrame& frame) {
  const auto* keys = std::get_if<typename Kind::Keys>(&g.kind);
  if (!keys) return;
  frame.first = plan.sums<typename Kind::Sums>();
  plan.all.push_back(Kind(*keys, frame));
}

}  // namespace

GaugePlan plan_gauges(const Scene& scene, const Axes& axes,
                      const std::vector<Solid<double>>& solids, double mass, double force_grain) {
  GaugePlan plan;
  GaugeFrame frame{scene, axes, solids, mass, force_grain};
  for (const Gauge& g : scene.gauges)
    [&]<class... Kind>(const std::variant<Kind...>*) {
      (add_gauge<Kind>(plan, g, frame), ...);
    }(static_cast<const gauge_kinds::Any*>(nullptr));
  return plan;
}

}  // namespace pbf::inline program_module
