// Gauges: flow is counted at the end of each update. Pressure is computed with the loads; level and
// velocity are computed only when they are read.
#pragma once

#include <algorithm>
#include <vector>

#include "lib/program/features/loads.h"
#include "lib/program/plan.h"

namespace pbf::inline program_module {
template <GaugeKind kind>
bool has_gauges(const Scene& s) {
  return std::any_of(s.gauges.begin(), s.gauges.end(),
                     [](const Gauge& g) { return g.kind == kind; });
}
inline bool has_flow_gauges(const Scene& s) { return has_gauges<GaugeKind::flow>(s); }
inline bool has_velocity_gauges(const Scene& s) { return has_gauges<GaugeKind::velocity>(s); }
inline std::int64_t per_id(const Sizes& n) { return n.particles; }
inline std::int64_t per_gate(const Sizes& n) { return std::int64_t(n.plan.gauges.gates.size()); }
inline std::int64_t per_probe(const Sizes& n) { return std::int64_t(n.plan.gauges.probes.size()); }
inline std::int64_t per_place(const Sizes& n) { return n.plan.gauges.places; }
}  // namespace pbf::inline program_module

namespace pbf::inline program_module::field {
/// In the order of ids, not of rows: bit k tells on which side of flow gauge k it is.
inline constexpr struct FlowSides : Plain<int> {
} flow_sides{{"flow sides", per_id, Life::run}};
inline constexpr struct Gates : Plain<FlowGate> {
} gates{{"gates", per_gate, Life::run}};
inline constexpr struct Flows : Plain<FlowCount> {
} flows{{"flows", per_gate, Life::state}};
/// The probes of level and velocity gauges, and the sums at their sample points.
inline constexpr struct Probes : Plain<Probe> {
} probes{{"probes", per_probe, Life::run}};
inline constexpr struct ProbeRows : Plain<ProbeSums, 1, std::int64_t> {
} probe_sums{{"probe sums", per_place, Life::run}};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// Updates the sides of all particles; `count`: also counts the particles that changed sides.
template <class G>
void take_sides(const G& c, bool count) {
  c.items(FlowPass<typename G::Real>{c[field::gates], int(c.plan.gauges.gates.size()),
                                     c[field::position], c[field::id], c[field::flow_sides],
                                     count ? c[field::flows] : nullptr, double(c.p.update_dt)});
}

struct CountFlow {
  static constexpr PassText text{"flow", "measure"};
  using Needs = pbf::Needs<Reads<field::position>, Reads<field::id>, Looks<field::gates>,
                           Looks<field::flow_sides>, Places<field::flow_sides>, Looks<field::flows>,
                           Adds<field::flows>>;
  template <class G>
  static void launch(const G& c) {
    take_sides(c, true);
  }
};

struct Gauges;

/// Adds what level and velocity gauges sum over the particles.
struct ReadProbes {
  static constexpr PassText text{"probes", "measure"};
  using Needs = pbf::Needs<Reads<field::position>, If<has_velocity_gauges, Reads<field::velocity>>,
                           Looks<field::probes>, Adds<field::probe_sums>>;
  template <class G>
  static void launch(const G& c) {
    c.items(ProbePass<typename G::Real>{c[field::probes], int(c.plan.gauges.probes.size()),
                                        c[field::position].rows(), c[field::velocity].rows(),
                                        c.template memory<Gauges>().update_dt,
                                        c[field::probe_sums].sums()});
  }
};

struct Gauges {
  using Passes = PassList<CountFlow, ReadProbes>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (s.gauges.empty()) return b.left_out("gauges", "no key gauges");
    if (has_flow_gauges(s)) b.template end<CountFlow>();
    if (has_gauges<GaugeKind::level>(s) || has_velocity_gauges(s)) b.template reading<ReadProbes>();
  }

  template <class Real>
  struct Memory : NoMemory {
    bool sides_are_current = false;  ///< of particles at flow gauges
    double update_dt = 0;            ///< s

    template <class C>
    void make(C& c) {
      update_dt = c.scene.time.step;
      c.put(field::gates, c.plan.gauges.gates);
      c.put(field::probes, c.plan.gauges.probes);
      c.put(field::patches, c.plan.gauges.patches);
    }
    template <class C>
    void forget(C&) {
      sides_are_current = false;
    }
    /// Computes the sides from which flow gauges count. Steps without time are not counted.
    template <class C>
    void before_steps(C& c, const StepRange&) {
      if (!has_flow_gauges(c.scene)) return;
      const bool timed = c.p.dt > 0;
      if (timed && !sides_are_current) take_sides(c.template granted<CountFlow>(), false);
      sides_are_current = timed;
    }
  };
};

}  // namespace pbf::inline PBF_VARIANT
