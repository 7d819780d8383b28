// The arrays of a scene's gauges, in the memory of the particles.
#pragma once

#include <vector>

#include "lib/program/gauges.h"

namespace pbf::inline PBF_VARIANT {

/// Sums of one reading, in the order of the scene's gauges.
struct GaugeSums {
  std::vector<ProbeSums> places;
  std::vector<FlowCount> flows;
  std::vector<Load> patches;
};

template <class Exec>
struct GaugeArrays {
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;
  Buffer<Probe> probe;
  Buffer<ProbeSums> sums;  ///< of all sample points
  Buffer<FlowGate> gate;
  Buffer<FlowCount> flow;  ///< part of the state
  Buffer<Patch> patch;

  void make(Exec& exec, const GaugePlan& plan) {
    const auto fill = [&](auto& buffer, const auto& from) {
      buffer.resize(from.size());
      exec.to_device(from.data(), from.size(), buffer.data());
    };
    fill(probe, plan.probes);
    sums.resize(std::size_t(plan.places));
    fill(gate, plan.gates);
    fill(flow, std::vector<FlowCount>(plan.gates.size()));
    fill(patch, plan.patches);
  }

  /// Sums over the particles around the sample points of all probes.
  template <class C>
  std::vector<ProbeSums> at_places(C& c, double update_dt) {
    std::vector<ProbeSums> all(sums.size());
    if (all.empty()) return all;
    c.exec.to_device(all.data(), all.size(), sums.data());
    c.items(ProbePass<typename C::Real>{probe.data(), int(probe.size()), c.position(), c.velocity(),
                                        update_dt, sums.data()});
    c.exec.to_host(sums.data(), all.size(), all.data());
    return all;
  }
};

}  // namespace pbf::inline PBF_VARIANT
