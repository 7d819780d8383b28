// The maxima, counts and sums of a measurement on the device.
#pragma once

#include "kernels/measure.h"
#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/program/list_capacity.h"

namespace pbf::PBF_VARIANT {

template <class Pass>
struct CountsOf {
  using Sum = MeasureCounts;
  Pass pass;
  __device__ const CountsOf& ready() const { return *this; }
  __device__ MeasureCounts operator()(int i) const { return pass.counts(i); }
};
template <class Pass>
struct TermsOf {
  using Sum = MeasureTerms;
  Pass pass;
  const MeasureCounts* counts;  ///< of all particles
  MeasureUnits unit;            ///< set by ready()
  __device__ TermsOf ready() const { return {pass, counts, MeasureUnits(*counts)}; }
  __device__ MeasureTerms operator()(int i) const { return pass.terms(i, unit); }
};

template <class Sum>
struct Reduction {
  Sum *of_block, *total;
  unsigned* blocks_done;  ///< 0 before and after a reduction
};

/// part[0] becomes the sum of `mine` over the threads of the block.
template <class Sum>
__device__ __forceinline__ void add_in_block(Sum* part, const Sum& mine) {
  __syncthreads();
  part[threadIdx.x] = mine;
  for (int half = kBlock / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) part[threadIdx.x].add(part[threadIdx.x + half]);
  }
}

/// The sum of term(i) for n particles; the block that is done last adds those of all blocks.
template <class Term>
__global__ void __launch_bounds__(kBlock)
    reduce_kernel(int n, Term term, Reduction<typename Term::Sum> r) {
  wait_for_previous();
  using Sum = typename Term::Sum;
  __shared__ Sum part[kBlock];
  __shared__ bool last;
  const auto ready = term.ready();
  Sum mine;
  for (std::int64_t i = blockIdx.x * kBlock + threadIdx.x; i < n;
       i += std::int64_t(gridDim.x) * kBlock)
    mine.add(ready(int(i)));
  add_in_block(part, mine);
  if (threadIdx.x == 0) {
    r.of_block[blockIdx.x] = part[0];
    __threadfence();
    last = atomicAdd(r.blocks_done, 1u) == gridDim.x - 1;
  }
  __syncthreads();
  if (!last) return;
  __threadfence();
  mine = Sum{};
  for (unsigned b = threadIdx.x; b < gridDim.x; b += kBlock) mine.add(r.of_block[b]);
  add_in_block(part, mine);
  if (threadIdx.x == 0) {
    *r.total = part[0];
    *r.blocks_done = 0;
  }
}

/// The memory of the two reductions of a measurement.
class MeasureSpace {
 public:
  struct Totals {
    MeasureCounts counts;
    MeasureTerms terms;
  };

  /// Allocates for at most n particles at the first call.
  void make(std::int64_t n, cudaStream_t stream) {
    if (totals_.size()) return;
    counts_.resize(std::size_t(reduce_blocks(n)));
    terms_.resize(std::size_t(reduce_blocks(n)));
    blocks_done_.resize(1);
    PBF_CUDA_CHECK(cudaMemsetAsync(blocks_done_.data(), 0, blocks_done_.bytes(), stream));
    host_.resize(1);
    totals_.resize(1);
  }
  Reduction<MeasureCounts> counts() {
    return {counts_.data(), &totals_.data()->counts, blocks_done_.data()};
  }
  Reduction<MeasureTerms> terms() {
    return {terms_.data(), &totals_.data()->terms, blocks_done_.data()};
  }
  /// Waits for the device.
  MeasureSums result(cudaStream_t stream) {
    PBF_CUDA_CHECK(cudaMemcpyAsync(host_.data(), totals_.data(), sizeof(Totals),
                                   cudaMemcpyDeviceToHost, stream));
    PBF_CUDA_CHECK(cudaStreamSynchronize(stream));
    return {host_.data()->counts, host_.data()->terms};
  }
  std::size_t bytes() const { return counts_.bytes() + terms_.bytes() + totals_.bytes(); }

 private:
  DeviceBuffer<MeasureCounts> counts_;
  DeviceBuffer<MeasureTerms> terms_;
  DeviceBuffer<Totals> totals_;
  PinnedBuffer<Totals> host_;
  DeviceBuffer<unsigned> blocks_done_;
};

}  // namespace pbf::PBF_VARIANT
