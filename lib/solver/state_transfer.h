// Copies a state between the arrays of a step and the host.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "kernels/axes.h"
#include "kernels/boundary/loads.h"
#include "kernels/pass_flow.h"
#include "kernels/step_counts.h"
#include "kernels/vec3.h"
#include "lib/solver/step_trace.h"

namespace pbf::inline PBF_VARIANT {

/// The arrays of the state of n particles, in memory that the executor can copy.
template <class Real>
struct StateArrays {
  Vec4<Real>*position, *velocity;
  int* id;
  StepCounts* counts;  ///< one
  Load* load;
  int walls;  ///< number of loads
  FlowCount* flow;
  int flows;  ///< flow gauges
};

/// Copies a state in one pass, because a run with a guard does so at every measurement.
template <class Real>
struct CopyStatePass {
  StateArrays<Real> from, to;
  PBF_HD void operator()(int i) const {
    to.position[i] = from.position[i];
    to.velocity[i] = from.velocity[i];
    to.id[i] = from.id[i];
    if (i != 0) return;
    *to.counts = *from.counts;
    for (int wall = 0; wall < from.walls; ++wall) to.load[wall] = from.load[wall];
    for (int gate = 0; gate < from.flows; ++gate) to.flow[gate] = from.flow[gate];
  }
};

/// Downloads n vectors: 3 numbers each, in the order of ids, along the scene's axes. The copy is
/// done in parts to save memory.
template <class Real, class Exec>
std::vector<double> rows_by_id(Exec& exec, const Axes& axes, std::size_t n, const Vec4<Real>* rows,
                               const int* id) {
  const std::size_t part = std::min<std::size_t>(n, 1 << 16);
  std::vector<int> ids(part);
  std::vector<Vec4<Real>> vectors(part);
  std::vector<double> out(3 * n);
  for (std::size_t first = 0; first < n; first += part) {
    const std::size_t count = std::min(part, n - first);
    exec.to_host(id + first, count, ids.data());
    exec.to_host(rows + first, count, vectors.data());
    for (std::size_t k = 0; k < count; ++k) {
      double* to = out.data() + 3 * std::size_t(ids[k]);
      const Vec4<Real>& v = vectors[k];
      to[axes.of[0]] = v.x, to[axes.of[1]] = v.y, to[axes.of[2]] = v.z;
    }
  }
  return out;
}

/// Downloads a state, in the order of ids: the order of rows is not part of a state.
template <class Real, class Exec>
SolverState download_state(Exec& exec, std::size_t n, const Axes& axes,
                           const StateArrays<Real>& from, std::int64_t updates,
                           std::int64_t steps) {
  SolverState s;
  s.precision = precision_of<Real>;
  s.updates = updates;
  s.steps = steps;
  s.position = rows_by_id(exec, axes, n, from.position, from.id);
  s.velocity = rows_by_id(exec, axes, n, from.velocity, from.id);
  s.id.resize(n);
  std::iota(s.id.begin(), s.id.end(), 0);
  StepCounts counts;
  exec.to_host(from.counts, 1, &counts);
  s.fast = std::int64_t(counts.fast);
  s.repeats = std::int64_t(counts.repeats);
  s.unresolved = std::int64_t(counts.unresolved);
  s.way_squared = counts.way_squared;
  s.loads.resize(std::size_t(from.walls));
  exec.to_host(from.load, s.loads.size(), s.loads.data());
  s.flows.resize(std::size_t(from.flows));
  exec.to_host(from.flow, s.flows.size(), s.flows.data());
  return s;
}

template <class Real, class Exec>
void upload_state(Exec& exec, const Axes& axes, const SolverState& s, const StateArrays<Real>& to) {
  const std::size_t n = s.id.size();
  const auto copy = [&](const std::vector<double>& from, Vec4<Real>* rows, Real w) {
    std::vector<Vec4<Real>> host(n);
    const double *x = from.data() + axes.of[0], *y = from.data() + axes.of[1],
                 *z = from.data() + axes.of[2];
    for (std::size_t k = 0; k < n; ++k)
      host[k] = {Real(x[3 * k]), Real(y[3 * k]), Real(z[3 * k]), w};
    exec.to_device(host.data(), n, rows);
  };
  copy(s.position, to.position, Real(1));
  copy(s.velocity, to.velocity, Real(0));
  exec.to_device(s.id.data(), n, to.id);
  StepCounts counts;
  counts.fast = std::uint64_t(s.fast);
  counts.repeats = std::uint64_t(s.repeats);
  counts.unresolved = std::uint64_t(s.unresolved);
  counts.way_squared = float(s.way_squared);
  exec.to_device(&counts, 1, to.counts);
  std::vector<Load> loads(std::size_t(to.walls));
  if (s.loads.size() == loads.size()) loads = s.loads;
  exec.to_device(loads.data(), loads.size(), to.load);
  std::vector<FlowCount> flows(std::size_t(to.flows));
  if (s.flows.size() == flows.size()) flows = s.flows;
  exec.to_device(flows.data(), flows.size(), to.flow);
}

}  // namespace pbf::inline PBF_VARIANT
