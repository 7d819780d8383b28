// What a kernel that runs passes in turns (turns.cuh) gives them: the row of a thread's particle
// and the entries of its list in registers, and rows of neighbors that other threads of the kernel
// write.
#pragma once

#include <type_traits>

#include "kernels/packed_position.h"
#include "lib/exec/cuda/transposed_lists.cuh"

namespace pbf::PBF_VARIANT {

/// A neighbor whose row the kernel writes between barriers: never loaded through the read-only
/// path.
struct ChangingNeighbor : Neighbor {};
__device__ __forceinline__ Vec4<float> load(GatheredRows<Vec4<float>> a, ChangingNeighbor j) {
  return a.rows()[j.row];
}

/// TransposedLists that the kernel itself may have made.
struct ChangingLists : TransposedLists {
  template <class F>
  __device__ __forceinline__ void for_each(int i, F&& f) const {
    const int4* o = overflow_words(i, count[i]);
    for (int e = 0; e < count[i]; ++e) f(ChangingNeighbor{{entry(i, e, o)}});
  }
};

/// What passes read and write of their own particle. Positions are stored at once, for other
/// threads; the density and the velocity at the end of the iterations.
struct KeptRow {
  int i;
  const Vec4<float>*position_rows, *velocity_rows, *direction_rows;
  Vec4<float> position, velocity, direction;  ///< direction: LambdaPass::position_out
  float density;

  __device__ __forceinline__ Vec4<float> of(const Vec4<float>* rows) const {
    if (rows == velocity_rows) return velocity;
    if (rows == direction_rows) return direction;
    return rows == position_rows ? position : rows[i];
  }
  __device__ __forceinline__ void set(Vec4<float>* rows, const Vec4<float>& value) {
    if (rows == velocity_rows) {
      velocity = value;
      return;
    }
    rows[i] = value;
    if (rows == position_rows) position = value;
    if (rows == direction_rows) direction = value;
  }
};

/// The index of that row, as passes take it (kernels/rows.h).
struct Kept {
  KeptRow* row;
  PBF_HD operator int() const { return row->i; }
};
__device__ __forceinline__ Vec4<float> load(GatheredRows<Vec4<float>> a, Kept k) {
  return k.row->of(a.rows());
}
__device__ __forceinline__ Vec4<float> row(OwnRows<Vec4<float>> a, Kept k) {
  return k.row->of(a.rows());
}
__device__ __forceinline__ void set_row(OwnRows<Vec4<float>> a, Kept k, const Vec4<float>& value) {
  k.row->set(a.rows(), value);
}
__device__ __forceinline__ void set_row(PackingRows a, Kept k, const Vec4<float>& value) {
  k.row->set(a.rows(), value);
}
__device__ __forceinline__ float row(OwnRows<const float>, Kept k) { return k.row->density; }
__device__ __forceinline__ void set_row(OwnRows<float>, Kept k, float value) {
  k.row->density = value;
}

/// The entries of a list that one of `lanes` threads sums over: lane, lane + lanes, ... All threads
/// of a warp take part.
template <int lanes>
class KeptEntries {
 public:
  /// n: entries of the list of particle i; 0 for none. stage: null, or the first ones.
  __device__ __forceinline__ KeptEntries(const ChangingLists& lists, int i, int lane, int n,
                                         const int4* overflow, const int* stage)
      : lists_(lists), i_(i), lane_(lane), n_(n), overflow_(overflow) {
    rounds_ = largest_of_warp((n + lanes - 1) / lanes);
#pragma unroll
    for (int k = 0; k < kKept; ++k) {
      const int e = lane + k * lanes;
      entry_[k] = e >= n ? lists.far : stage ? stage[e] : lists.entry(i, e, overflow);
    }
  }
  /// Adds all of them to a sum of a pass. The usual numbers of rows are loaded at once, if one row
  /// of a neighbor is all that the pass needs.
  template <class Pass, class Own, class Sum>
  __device__ __forceinline__ void add_to(const Pass& pass, const Own& own, Sum& sum) const {
    constexpr int least = lanes == 16 ? 2 : 4;
    if constexpr (sizeof(pass.other(ChangingNeighbor{{0}})) > sizeof(Vec4<float>)) {
      add_groups<0, least>(pass, own, sum);
    } else {
      if (rounds_ <= least)
        add<0, least>(pass, own, sum);
      else if (rounds_ == least + 1)
        add<0, least + 1>(pass, own, sum);
      else
        add<0, least + 2>(pass, own, sum);
      add_groups<least + 2, 2>(pass, own, sum);
    }
    for (int k = kKept; k < rounds_; ++k) {
      const int e = lane_ + k * lanes;
      const int j = e < n_ ? lists_.entry(i_, e, overflow_) : lists_.far;
      pass.add(sum, own, pass.other(ChangingNeighbor{{j}}));
    }
  }

 private:
  static constexpr int kKept = 64 / lanes;
  /// n entries from k on. All rows are asked for before the first is used.
  template <int k, int n, class Pass, class Own, class Sum>
  __device__ __forceinline__ void add(const Pass& pass, const Own& own, Sum& sum) const {
    decltype(pass.other(ChangingNeighbor{{0}})) other[n];
#pragma unroll
    for (int j = 0; j < n; ++j) other[j] = pass.other(ChangingNeighbor{{entry_[k + j]}});
#pragma unroll
    for (int j = 0; j < n; ++j) pass.add(sum, own, other[j]);
  }
  /// All from k on, n at a time.
  template <int k, int n, class Pass, class Own, class Sum>
  __device__ __forceinline__ void add_groups(const Pass& pass, const Own& own, Sum& sum) const {
    if constexpr (k < kKept) {
      static_assert(k + n <= kKept);
      if (k >= rounds_) return;
      add<k, n>(pass, own, sum);
      add_groups<k + n, n>(pass, own, sum);
    }
  }

  const ChangingLists& lists_;
  int i_, lane_, n_, rounds_;  ///< rounds_: of the longest list of the warp
  const int4* overflow_;
  int entry_[kKept];
};

}  // namespace pbf::PBF_VARIANT
