// Gauges: flow is counted at the end of each update. Pressure is computed with the loads; level and
// velocity are computed only when they are read (lib/solver/gauge_arrays.h).
#pragma once

#include <algorithm>

#include "kernels/pass_flow.h"
#include "lib/program/pass.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module::field {
/// Of each particle, in the order of ids: bits say on which side of each flow gauge it is.
inline constexpr FieldInfo flow_sides{"flow sides", Type::int32, 1, Rows::particles};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// `count`: what has changed sides counts.
template <class C>
void take_sides(C& c, bool count) {
  auto& g = c.gauges;
  c.items(FlowPass<typename C::Real>{g.gate.data(), int(g.gate.size()), c.position(), c.ids(),
                                     c.template data<int>(field::flow_sides),
                                     count ? g.flow.data() : nullptr, double(c.p.update_dt)});
}

struct CountFlow {
  static PassInfo info() {
    return {"flow", "measure", {{&field::position}, {&field::id}}, {hidden({&field::flow_sides})}};
  }
  template <class C>
  static void launch(C& c) {
    take_sides(c, true);
  }
};

struct Gauges {
  using Passes = PassList<CountFlow>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (s.gauges.empty()) return b.left_out("gauges", "no key gauges");
    const auto flow = [](const Gauge& g) { return g.kind == GaugeKind::flow; };
    if (std::any_of(s.gauges.begin(), s.gauges.end(), flow)) b.template end<CountFlow>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
