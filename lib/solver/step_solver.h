// Solver over a Stepper: what the two backends share. Host side only.
#pragma once

#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "lib/base/release.h"
#include "lib/solver/params.h"
#include "lib/solver/solver.h"
#include "lib/solver/stepper.h"

namespace pbf::inline PBF_VARIANT {

/// Positions and velocities of a scene in the internal frame, in the order of ids.
template <class Real>
struct InternalState {
  std::vector<Vec4<Real>> position, velocity;
  std::vector<int> id;
};

/// Takes the particles, and lets go of each of their arrays as soon as it is converted: while a
/// solver is made no more memory is held than it needs later.
template <class Real>
InternalState<Real> to_internal(const Scene& s, const Axes& axes, Particles particles) {
  const std::size_t n = particles.size();
  const double h = s.h();
  InternalState<Real> out;
  const Double3 o = s.origin();
  const std::size_t a[3] = {std::size_t(axes.of[0]), std::size_t(axes.of[1]),
                            std::size_t(axes.of[2])};
  out.position.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Double3& x = particles.position[i];
    const auto at = [&](std::size_t k) { return Real((x[k] - o[k]) / h); };
    out.position[i] = {at(a[0]), at(a[1]), at(a[2]), Real(1)};
  }
  release(particles.position);
  out.velocity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Double3& v = particles.velocity[i];
    out.velocity[i] = {Real(v[a[0]] / h), Real(v[a[1]] / h), Real(v[a[2]] / h), Real(0)};
  }
  release(particles.velocity);
  out.id.resize(n);
  std::iota(out.id.begin(), out.id.end(), 0);
  return out;
}

}  // namespace pbf::inline PBF_VARIANT

namespace pbf::inline solver_module {

/// Sums in the internal frame, after so many updates and steps -> Measures in SI units and the
/// scene's axes (lib/solver/DIAGNOSTICS.md).
Measures to_measures(const MeasureSums& sums, const Scene& scene, const Plan& plan,
                     std::int64_t update, std::int64_t steps);

/// Error(internal) at a level above 0, where an update has no single trace.
void refuse_trace(int level);

/// An empty snapshot of n particles with every array allocated and the ids filled in; position and
/// id always, velocity and density where `fields` names them. Error(bad_input) for another name.
Snapshot empty_snapshot(const std::vector<std::string>& fields, ScalarType type, std::size_t n,
                        std::int64_t update, double time);

}  // namespace pbf::inline solver_module
