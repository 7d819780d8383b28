// The arrays of a Stepper over the memory of an executor, and what is done with them as a whole.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kernels/cell_index.h"
#include "kernels/params.h"
#include "kernels/step_counts.h"
#include "lib/base/release.h"
#include "lib/solver/state_transfer.h"

namespace pbf::inline PBF_VARIANT {

/// Positions in h, velocities in h/s, densities in rho0; one entry per particle, in the order of
/// the last sort. A pass that reorders or overwrites writes into `other_...`.
template <class Real, class Exec>
struct ParticleArrays {
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;

  /// A copy of the state, from which the updates since can be repeated.
  struct Saved {
    Buffer<Vec4<Real>> position, velocity;
    Buffer<int> id;
    Buffer<StepCounts> counts;
    StateArrays<Real> state() {
      return {position.data(), velocity.data(), id.data(), counts.data()};
    }
    std::size_t bytes() const { return position.bytes() + velocity.bytes() + id.bytes(); }
  };

  Buffer<Vec4<Real>> position, other_position, velocity, other_velocity, curl;
  Buffer<Real> density;
  Buffer<int> id, other_id, bin, order, bin_start;
  Buffer<StepCounts> counts;  ///< one

  /// Takes over a state, whose vectors are empty then.
  void make(Exec& exec, const Params<Real>& p, std::vector<Vec4<Real>>& first_position,
            std::vector<Vec4<Real>>& first_velocity, std::vector<int>& first_id) {
    const std::size_t n = first_position.size();
    // Executors whose lists are padded read one particle more, infinitely far away for any kernel.
    const std::size_t padded = n + Exec::padding;
    for (auto* b : {&position, &other_position, &velocity, &other_velocity}) b->resize(padded);
    for (auto* b : {&id, &other_id, &bin}) b->resize(n);
    if (!Exec::order_in_place) order.resize(n);
    density.resize(n);
    counts.resize(1);
    const StepCounts none;
    exec.to_device(&none, 1, counts.data());
    bin_start.resize(std::size_t(bin_count(p)) + 1);
    if (p.vorticity > Real(0)) curl.resize(padded);
    if (Exec::padding) {
      const std::vector<Vec4<Real>> far(Exec::padding, {Real(1e9), Real(1e9), Real(1e9), Real(1)}),
          zero(Exec::padding, {0, 0, 0, 0});
      const auto fill = [&](const auto& rows, auto& b) {
        exec.to_device(rows.data(), rows.size(), b.data() + n);
      };
      for (auto* b : {&position, &other_position}) fill(far, *b);
      for (auto* b : {&velocity, &other_velocity}) fill(zero, *b);
      if (curl.size()) fill(zero, curl);
    }
    exec.to_device(first_position.data(), n, position.data());
    exec.to_device(first_velocity.data(), n, velocity.data());
    exec.to_device(first_id.data(), n, id.data());
    release(first_position);  // before the lists are made
    release(first_velocity);
    release(first_id);
  }

  int size() const { return int(id.size()); }
  StateArrays<Real> state() { return {position.data(), velocity.data(), id.data(), counts.data()}; }

  /// n numbers: the order of a sort, free after it.
  int* sort_order() { return (Exec::order_in_place ? other_id : order).data(); }

  /// What a sort has written becomes the state.
  void swap() {
    std::swap(position, other_position);
    std::swap(id, other_id);
    swap_velocity();
    placement_ ^= 1;
  }
  void swap_velocity() {
    std::swap(velocity, other_velocity);
    placement_ ^= 2;
  }
  /// 0 .. 3: which of the two arrays each part of the state lies in.
  int placement() const { return placement_; }

  void save(Exec& exec, Saved& s) {
    const auto n = std::size_t(size());
    s.position.resize(n);
    s.velocity.resize(n);
    s.id.resize(n);
    s.counts.resize(1);
    exec.for_each(size(), CopyStatePass<Real>{state(), s.state()});
  }
  void restore(Exec& exec, Saved& s) {
    exec.for_each(size(), CopyStatePass<Real>{s.state(), state()});
  }

  std::size_t bytes() const {
    return position.bytes() + other_position.bytes() + velocity.bytes() + other_velocity.bytes() +
           id.bytes() + other_id.bytes() + bin.bytes() + order.bytes() + density.bytes() +
           bin_start.bytes() + curl.bytes();
  }

 private:
  int placement_ = 0;
};

}  // namespace pbf::inline PBF_VARIANT
