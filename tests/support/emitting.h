// A feature that adds and removes particles in every update: a shower, and a drain in a corner of
// the floor. It stands in this file alone.
#pragma once

#include <memory>

#include "kernels/row_state.h"
#include "lib/program/features.h"
#include "lib/program/time_order.h"
#include "lib/solver/solver.h"

namespace pbf::PBF_VARIANT {

namespace shower {
constexpr int kPerSort = 3, kAcross = 6;  ///< particles; places along x and y
/// h, in the internal frame of a box that is 1 m high and across.
template <class Real>
PBF_HD Vec4<Real> place_of(std::int64_t id, Real width, Real top) {
  const auto k = int(id % (kAcross * kAcross));
  return {width * Real(k % kAcross + 1) / Real(kAcross + 1),
          width * Real(k / kAcross + 1) / Real(kAcross + 1), top, Real(1)};
}
}  // namespace shower

/// Rows in the corner leave in the next sort.
template <class Real>
struct DrainPass {
  OwnRows<const Vec4<Real>> position;
  OwnRows<int> id;
  Real edge;  ///< h
  PBF_HD void operator()(int i) const {
    const Vec4<Real> x = position[i];
    if (x.x < edge && x.y < edge && x.z < edge) id[i] = -1 - id[i];
  }
};
struct Drain {
  static constexpr PassText text{"drain", "predict"};
  using Needs = pbf::Needs<Reads<field::position>, Updates<field::id>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    c.items(DrainPass<Real>{c[field::position], c[field::id], Real(0.3 / c.scene.h())});
  }
};

/// Item j becomes the j-th row behind the last.
template <class Real>
struct EmitPass {
  const RowState* state;
  OwnRows<Vec4<Real>> position, velocity;
  Vec4<Real>* free;  ///< velocity without a push, which new particles have not had; null: none
  OwnRows<int> id;
  Real width, top, speed;  ///< h, h/s
  int capacity;
  PBF_HD void operator()(int j) const {
    const auto row = int(state->rows) + j;
    if (row >= capacity) return;
    id[row] = int(state->next_id) + j;
    position[row] = shower::place_of<Real>(id[row], width, top);
    velocity[row] = {Real(0), Real(0), -speed, Real(0)};
    if (free) free[row] = velocity[row];
  }
};
struct CountNewPass {
  RowState* state;
  int added, capacity;
  PBF_HD void operator()(int) const {
    const std::int64_t room = capacity - state->rows, in = room < added ? room : added;
    state->rows += in;
    state->next_id += in;
    state->refused += added - in;
  }
};
struct Emit {
  static constexpr PassText text{"emit", "predict"};
  using Needs = pbf::Needs<Looks<field::row_state>, Places<field::row_state>,
                           Writes<field::position>, Writes<field::velocity>, Writes<field::id>,
                           If<is_second_order, Writes<field::free_velocity>>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    const Real h = Real(c.scene.h());
    c.items(shower::kPerSort,
            EmitPass<Real>{c[field::row_state], c[field::position], c[field::velocity],
                           c.declared(field::free_velocity), c[field::id], 1 / h, Real(0.9) / h,
                           2 / h, c.capacity()});
    c.items(1, CountNewPass{c[field::row_state], shower::kPerSort, c.capacity()});
  }
};

struct Shower {
  static constexpr bool changes_rows = true;
  using Passes = PassList<Drain, Emit>;
  static void add(const Scene&, auto& b) {
    b.rows(Drain());
    b.rows(Emit());
  }
  template <class Real>
  struct Memory : NoMemory {
    template <class C>
    static std::int64_t new_rows(C&, const StepRange& steps) {
      return std::int64_t(steps.count) * shower::kPerSort;
    }
  };
};
using EmittingFeatures = Features::With<Shower>;

}  // namespace pbf::PBF_VARIANT

namespace pbf::test {

/// A solver with the shower, for the scene's precision: on the CPU, and with the host's bits on a
/// CUDA device.
std::unique_ptr<Solver> emitting_on_cpu(const Scene&, const Plan&, Particles, int threads);
std::unique_ptr<Solver> emitting_on_cuda(const Scene&, const Plan&, Particles);

}  // namespace pbf::test
