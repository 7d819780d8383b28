// Reads what passes have summed for loads and gauges. With Interval::ends, means begin again.
#pragma once

#include <vector>

#include "lib/solver/granted.h"
#include "lib/solver/solver.h"

namespace pbf::inline PBF_VARIANT {

/// Rows first ... first + count - 1 of field::loads.
template <class C>
std::vector<Load> read_loads(C& c, std::int64_t first, std::int64_t count, Interval interval) {
  if (count <= 0) return {};
  std::vector<Load> now(std::size_t(count), Load{}), none(now.size());
  Load* from = c.data(field::loads) + first;
  c.exec.to_host(from, now.size(), now.data());
  if (interval == Interval::ends) c.exec.to_device(none.data(), none.size(), from);
  return now;
}
/// The loads of walls and obstacles, whose rows are the first.
template <class C>
std::vector<Load> read_loads(C& c, Interval interval) {
  return read_loads(c, 0, load_walls(c.scene) - pressure_gauges(c.scene), interval);
}

template <class C>
GaugeSums read_gauges(C& c, Interval interval) {
  c.exec.begin();
  const GaugePlan& plan = c.plan.gauges;
  GaugeSums sums;
  sums.places.resize(std::size_t(plan.places));
  if (!sums.places.empty()) {
    c.put(field::probe_sums, sums.places);
    launch_one<ReadProbes>(c);
    c.exec.to_host(c.data(field::probe_sums), sums.places.size(), sums.places.data());
  }
  if (has_pressure_gauges(c.scene))
    sums.patches = read_loads(c, first_gauge_row(c.scene), pressure_gauges(c.scene), interval);
  sums.flows.resize(plan.gates.size());
  if (!sums.flows.empty())
    c.exec.to_host(c.data(field::flows), sums.flows.size(), sums.flows.data());
  if (interval == Interval::ends) {
    std::vector<FlowCount> next = sums.flows;
    for (FlowCount& f : next) f.since = 0, f.time = 0;
    c.put(field::flows, next);
  }
  c.exec.mark("measure");
  return sums;
}

}  // namespace pbf::inline PBF_VARIANT
