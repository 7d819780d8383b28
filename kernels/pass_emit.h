// Passes of emitters and sinks. kernels/README.md, "Emitters and sinks".
#pragma once

#include "kernels/emission.h"
#include "kernels/row_state.h"

namespace pbf::PBF_VARIANT {

/// The next step of the table.
struct NextEmissionPass {
  EmissionRow* row;
  PBF_HD void operator()(int) const { row->now = row->next++; }
};

/// Item j becomes a row behind the last, if a layer begins in this step: so many items as particles
/// may begin in a step.
template <class Real>
struct EmitLayersPass {
  Params<Real> p;
  Pipes<Real> pipes;
  const RowState* state;
  OwnRows<Vec4<Real>> position, velocity;
  Vec4<Real>* free;  ///< velocity without pushes; null in first order
  OwnRows<int> id;
  int most_born, capacity;
  PBF_HD void operator()(int j) const {
    for (int e = 0; e < pipes.nozzles; ++e) {
      const int columns = pipes.nozzle[e].columns, items = columns * most_born;
      if (j < items) return emit(e, j / columns, j % columns);
      j -= items;
    }
  }

 private:
  PBF_HD void emit(int e, int n, int k) const {
    const NozzleStep<Real>& s = pipes.step(e);
    if (n >= s.born) return;
    const int layer = s.held - s.born + n, mine = s.id[layer] + k;
    const std::int64_t to = state->rows + (mine - state->next_id);
    if (to >= capacity) return;
    const auto row = int(to);
    const Vec3<Real> v = s.speed * pipes.nozzle[e].normal,
                     x = pipes.place(e, layer, mine, -(p.dt * s.speed));
    id[row] = mine;
    position[row] = with_w(x, Real(1));
    velocity[row] = with_w(v, Real(0));
    if (free) free[row] = velocity[row];
    if (pipes.near.way_left_squared) pipes.near.mark_near(row);
    pipes.book.add_energy(e, EmissionBook::energy(x, v, pipes.gravity));
  }
};
/// After it.
template <class Real>
struct CountEmittedPass {
  Pipes<Real> pipes;
  RowState* state;
  int capacity;
  PBF_HD void operator()(int) const {
    std::int64_t born = 0;
    for (int e = 0; e < pipes.nozzles; ++e)
      born += std::int64_t(pipes.step(e).born) * pipes.nozzle[e].columns;
    const std::int64_t room = capacity - state->rows, in = room < born ? room : born;
    if (in < born && state->refused == 0) pipes.book.sums->first = state->next_id + in;
    state->rows += in;
    state->next_id += born;
    state->refused += born - in;
  }
};

/// After the prediction, for all rows.
template <class Real>
struct HoldPredictedPass {
  Params<Real> p;
  Pipes<Real> pipes;
  OwnRows<Vec4<Real>> position, velocity;
  Vec4<Real>* free;
  OwnRows<const int> id;
  PBF_HD void operator()(int i) const {
    Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    const Vec3<Real> before = v;
    bool held;
    if (!pipes.hold(id[i], true, p, x, v, held)) return;
    // What a pipe stops is no push, as at walls (pass_predict.h).
    if (free) free[i] = with_w(held ? v : xyz(free[i]) + (v - before), Real(0));
    position[i] = with_w(x, position[i].w);
    velocity[i] = with_w(v, Real(0));
  }
};

/// Lists the rows in and near pipes, when lists are made.
struct ClearPipeRowsPass {
  int* count;
  PBF_HD void operator()(int) const { *count = 0; }
};
template <class Real>
struct FindPipeRowsPass {
  Pipes<Real> pipes;
  OwnRows<const Vec4<Real>> position;
  int *row, *count;
  PBF_HD void operator()(int i) const {
    for (int e = 0; e < pipes.nozzles; ++e) {
      if (!pipes.is_near(e, xyz(position[i]), Real(kNearRoom))) continue;
      row[take_place(count)] = i;
      return;
    }
  }
};

/// After each correction, and at the end of an update, for the listed rows.
template <class Real>
struct HoldPass {
  Params<Real> p;
  Pipes<Real> pipes;
  const int* listed;
  OwnRows<Vec4<Real>> position, velocity;
  OwnRows<const int> id;
  PBF_HD int row(int k) const { return listed[k]; }
  PBF_HD void operator()(int k) const {
    const int i = row(k);
    Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    bool held;
    if (!pipes.hold(id[i], false, p, x, v, held)) return;
    position[i] = with_w(x, position[i].w);
    velocity[i] = with_w(v, Real(0));
  }
};

/// Rows in a sink leave in the next sort.
template <class Real>
struct SinkPass {
  const SinkBox<Real>* sink;
  int sinks, first;  ///< number of the first sum
  Vec3<Real> gravity;
  EmissionBook book;
  OwnRows<const Vec4<Real>> position, velocity;
  OwnRows<int> id;
  PBF_HD void operator()(int i) const {
    const int mine = id[i];
    if (mine < 0) return;
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    for (int k = 0; k < sinks; ++k) {
      const SinkBox<Real>& s = sink[k];
      if (!(x.x >= s.min.x && x.y >= s.min.y && x.z >= s.min.z && x.x <= s.max.x &&
            x.y <= s.max.y && x.z <= s.max.z))
        continue;
      id[i] = -1 - mine;
      add_whole(&book.sums[first + k].particles, 1);
      book.add_energy(first + k, EmissionBook::energy(x, v, gravity));
      const Real along[3] = {v.x, v.y, v.z};
      for (int a = 0; a < 3; ++a) book.add_momentum(first + k, a, double(along[a]));
      return;
    }
  }
};

}  // namespace pbf::PBF_VARIANT
