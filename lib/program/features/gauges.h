// Gauges: flow is counted at the end of each update. Pressure is computed with the loads; the
// others are computed only when they are read.
#pragma once

#include "lib/program/features/loads.h"

namespace pbf::program_module {
inline std::int64_t per_id(const Sizes& n) { return n.particles; }
template <class Tally>
std::int64_t per_sum(const Sizes& n) {
  return n.plan.gauges.of<Tally>().sums;
}
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// In the order of ids, not of rows: bit k tells on which side of flow gauge k it is.
inline constexpr struct FlowSides : Plain<int> {
} flow_sides{{"flow sides", per_id, Life::run}};
inline constexpr auto& gates = gauge_sites<FlowTally>;
inline constexpr struct Flows : Plain<FlowCount> {
} flows{{"flows", per_sum<FlowTally>, Life::state}};
/// Of a tally that is made at a reading.
template <class Tally>
struct GaugeSums : Plain<typename Tally::Sums, 1, std::int64_t> {};
template <class Tally>
inline constexpr GaugeSums<Tally> gauge_sums{{Tally::sums, per_sum<Tally>, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

/// Updates the sides of all particles; `count`: also counts the particles that changed sides.
template <class G>
void take_sides(const G& c, bool count) {
  c.items(FlowPass<typename G::Real>{
      c[field::gates], gauges_of<FlowTally>(c.scene), c[field::position], c[field::id],
      c[field::flow_sides], count ? c.declared(field::flows) : nullptr, double(c.p.update_dt)});
}

struct CountFlow {
  static constexpr PassText text{"flow", "measure"};
  using Needs = pbf::Needs<Reads<field::position>, Reads<field::id>, Looks<field::gates>,
                           Looks<field::flow_sides>, Places<field::flow_sides>, Looks<field::flows>,
                           Adds<field::flows>>;
  static void launch(const auto& c) { take_sides(c, true); }
};

/// Of the particles that begin in an update.
struct TakeNewSides {
  static constexpr PassText text{"sides", "measure"};
  using Needs = pbf::Needs<Reads<field::position>, Reads<field::id>, Looks<field::gates>,
                           Places<field::flow_sides>>;
  static void launch(const auto& c) { take_sides(c, false); }
};

struct Gauges;

/// Adds what gauges sum over the particles at a reading.
template <class Tally>
struct ReadGauges {
  static constexpr PassText text{Tally::sites, "measure"};
  using Needs =
      pbf::Needs<Reads<field::position>,
                 std::conditional_t<Tally::reads_velocity, Reads<field::velocity>, pbf::Needs<>>,
                 Looks<field::gauge_sites<Tally>>, Adds<field::gauge_sums<Tally>>>;
  static void launch(const auto& c) {
    c.items(gauge_pass(c[field::gauge_sites<Tally>], gauges_of<Tally>(c.scene),
                       c[field::position].rows(), c.declared(field::velocity),
                       c.template memory<Gauges>().update_dt, c[field::gauge_sums<Tally>].sums()));
  }
};

template <class Tally>
constexpr bool is_read_by_pass = requires {
  Tally::sums;
};
template <class... Tally>
typename Joined<
    PassList<CountFlow, TakeNewSides>,
    std::conditional_t<is_read_by_pass<Tally>, PassList<ReadGauges<Tally>>, PassList<>>...>::type
gauge_passes(const std::tuple<TalliedGauges<Tally>...>&);

struct Gauges {
  using Passes = decltype(gauge_passes(std::declval<gauge_keys::EachTally<TalliedGauges>>()));
  static void add(const Scene& s, auto& b) {
    if (s.gauges.empty()) return b.left_out("gauges", "no key gauges");
    if (gauges_of<FlowTally>(s) > 0) b.end(CountFlow());
    if (gauges_of<FlowTally>(s) > 0 && has_emitters(s)) b.rows(TakeNewSides());
    const auto add_pass = [&]<class Tally>(const TalliedGauges<Tally>&) {
      if constexpr (is_read_by_pass<Tally>)
        if (gauges_of<Tally>(s) > 0) b.reading(ReadGauges<Tally>());
    };
    std::apply([&](const auto&... tally) { (add_pass(tally), ...); },
               gauge_keys::EachTally<TalliedGauges>());
  }

  template <class Real>
  struct Memory : NoMemory {
    bool sides_are_current = false;  ///< of particles at flow gauges
    double update_dt = 0;            ///< s

    void make(auto& c) {
      update_dt = c.scene.time.step;
      std::apply(
          [&]<class... Tally>(const TalliedGauges<Tally>&... of) {
            (c.put(field::gauge_sites<Tally>, of.sites), ...);
          },
          c.plan.gauges.tallies);
    }
    void forget(auto&) { sides_are_current = false; }
    /// Computes the sides from which flow gauges count. Steps without time are not counted.
    void before_steps(auto& c, const StepRange&) {
      if (gauges_of<FlowTally>(c.scene) == 0) return;
      const bool timed = c.p.dt > 0;
      if (timed && !sides_are_current)
        c.template as_pass<CountFlow>([](const auto& pass) { take_sides(pass, false); });
      sides_are_current = timed;
    }
  };
};

}  // namespace pbf::PBF_VARIANT
