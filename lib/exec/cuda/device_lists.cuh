// The memory of neighbor lists on the device, and the kernels that make them.
#pragma once

#include <algorithm>

#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/kernels.cuh"

namespace pbf::PBF_VARIANT {

/// If a list is longer than its memory, making it records its length and writes nothing beyond;
/// grow() then enlarges the memory.
class DeviceLists {
 public:
  explicit DeviceLists(ListCapacity capacity) : capacity_(capacity) {
    state_.resize(1);
    state_host_.resize(1);
  }

  /// The lists of `n` particles; far: the row that pads lists, behind all rows.
  template <class Rows, class Real>
  TransposedLists make(Launcher& launcher, const Rows& n, int far, const Vec4<Real>* position,
                       const int* bin_start, const Params<Real>& p) {
    const TransposedLists lists = prepare(far);
    p.dimensions == 2 ? make_in<2>(launcher, n, far, position, bin_start, p)
                      : make_in<3>(launcher, n, far, position, bin_start, p);
    return lists;
  }
  /// Their memory, for a kernel that makes them with pass().
  TransposedLists prepare(int far) {
    allocate(far);
    return {words_.data(),    overflows_.data(), count_.data(),      overflow_of_.data(),
            list_stride(far), capacity_.first,   capacity_.overflow, far};
  }
  /// unchanged: as in ListPass.
  template <int D, bool unchanged = true, class Real>
  ListPass<Real, D, unchanged> pass(int far, const Vec4<Real>* position, const int* bin_start,
                                    const Params<Real>& p) {
    return {{p, position, bin_start},
            words_.data(),
            overflows_.data(),
            count_.data(),
            overflow_of_.data(),
            state_.data(),
            capacity_,
            list_stride(far),
            far};
  }
  /// To be called before the next two, which need the stream to be done.
  void ask_state(cudaStream_t stream);
  /// Since the memory last grew.
  ListDemand demand() const;
  /// Whether lists of at most n particles had too little memory, or would have if they needed as
  /// many overflows as those of another rank; they then have more. To be made again in any case if
  /// there was a demand, also elsewhere.
  bool grow(int n, const ListDemand& elsewhere, cudaStream_t stream);
  /// After grow() was false: more memory if little is left, so that later lists fit. The lists are
  /// to be made again.
  bool enlarge(int n, cudaStream_t stream);
  void clear_state(cudaStream_t stream) {
    PBF_CUDA_CHECK(cudaMemsetAsync(state_.data(), 0, sizeof(ListState), stream));
  }
  ListState* state() { return state_.data(); }
  std::size_t bytes() const {
    return words_.bytes() + overflows_.bytes() + overflow_of_.bytes() + count_.bytes();
  }

 private:
  template <int D, class Rows, class Real>
  void make_in(Launcher& launcher, const Rows& n, int far, const Vec4<Real>* position,
               const int* bin_start, const Params<Real>& p) {
    const auto of = pass<D>(far, position, bin_start, p);
    if (far <= kListLanes)
      launcher.start(list_lanes_kernel<Rows, Real, D>, of.lanes * most(n), kBlock, 0, n, of);
    else
      launcher.start(list_kernel<Rows, Real, D>, most(n), kListBlock, 0, n, of);
  }
  void allocate(int n);
  void use(const ListCapacity& capacity, int n);

  ListCapacity capacity_;
  DeviceBuffer<int4> words_, overflows_;
  DeviceBuffer<int> count_, overflow_of_;
  DeviceBuffer<ListState> state_;
  PinnedBuffer<ListState> state_host_;
};

}  // namespace pbf::PBF_VARIANT
