// Gauges: flow is counted at the end of each update. Pressure is computed with the loads; level and
// velocity are computed only when they are read (lib/solver/gauge_probes.h).
#pragma once

#include "kernels/pass_flow.h"
#include "lib/program/gauges.h"
#include "lib/program/pass.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module::field {
/// Per particle, in the order of ids: bit k tells on which side of flow gauge k it is.
inline constexpr struct FlowSides : Plain<int> {
} flow_sides{{"flow sides", per_particle, Life::rows}};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// Updates the sides of all particles; `count`: also counts the particles that changed sides.
template <class G>
void take_sides(const G& c, bool count) {
  auto& g = c.context().gauges;
  c.items(FlowPass<typename G::Real>{g.gate.data(), int(g.gate.size()), c[field::position],
                                     c[field::id], c[field::flow_sides],
                                     count ? g.flow.data() : nullptr, double(c.p.update_dt)});
}

struct CountFlow {
  static constexpr PassText text{"flow", "measure"};
  using Needs = pbf::Needs<Reads<field::position>, Reads<field::id>, Reads<field::flow_sides>,
                           Places<field::flow_sides>>;
  template <class G>
  static void launch(const G& c) {
    take_sides(c, true);
  }
};

struct Gauges {
  using Passes = PassList<CountFlow>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (s.gauges.empty()) return b.left_out("gauges", "no key gauges");
    if (has_gauges<FlowCount>(s)) b.template end<CountFlow>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
