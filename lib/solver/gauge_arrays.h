// The arrays of the gauges that are counted in updates, in the memory of the particles.
#pragma once

#include <vector>

#include "lib/program/gauges.h"

namespace pbf::inline PBF_VARIANT {

template <class Exec>
struct GaugeArrays {
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;
  Buffer<FlowGate> gate;
  Buffer<FlowCount> flow;  ///< part of the state
  Buffer<Patch> patch;

  void make(Exec& exec, const GaugePlan& plan) {
    const auto fill = [&](auto& buffer, const auto& from) {
      buffer.resize(from.size());
      exec.to_device(from.data(), from.size(), buffer.data());
    };
    fill(gate, plan.sites<FlowGate>());
    fill(flow, std::vector<FlowCount>(gate.size()));
    fill(patch, plan.sites<Patch>());
  }
};

}  // namespace pbf::inline PBF_VARIANT
