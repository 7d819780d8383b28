// Measurements and other sums over rows of the CUDA executor.
#pragma once

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <algorithm>
#include <cub/device/device_reduce.cuh>
#include <vector>

#include "lib/exec/cuda/bin_counts.cuh"
#include "lib/exec/cuda/cuda_rows.cuh"
#include "lib/exec/cuda/reduce.cuh"
#include "lib/solver/executor.h"

namespace pbf::PBF_VARIANT {

class CudaSums : public CudaRows {
 public:
  /// total: most particles of the whole scene; rows: most rows here.
  CudaSums(std::int64_t total, std::int64_t rows) : total_(total), rows_(rows) {}

  /// See CpuExec. The maxima stay on the device for the sums, so the host waits once.
  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    if (n == 0) return {};
    measure_.make(std::max(rows_, total_), launcher_.ready());
    const int threads = kBlock * reduce_blocks(n);
    launch(reduce_kernel<CountsOf<Pass>>, threads, kBlock, 0, n, CountsOf<Pass>{pass},
           measure_.counts());
    launch(reduce_kernel<TermsOf<Pass>>, threads, kBlock, 0, n,
           TermsOf<Pass>{pass, measure_.counts().total, {}}, measure_.terms());
    return measure_.result(launcher_.ready());
  }
  template <ReducePass Pass, class Join>
  MeasureSums reduce(int n, const Pass& pass, const Join& join) {
    measure_.make(std::max(rows_, total_), launcher_.ready());
    const int threads = kBlock * reduce_blocks(n);
    const auto sum_of_rows = [&](const auto& term, const auto& reduction, auto& sum) {
      if (n == 0) return;
      launch(reduce_kernel<std::decay_t<decltype(term)>>, threads, kBlock, 0, n, term, reduction);
      to_host(reduction.total, 1, &sum);
    };
    MeasureCounts counts;
    MeasureTerms terms;
    sum_of_rows(CountsOf<Pass>{pass}, measure_.counts(), counts);
    join(counts);
    to_device(&counts, 1, measure_.counts().total);
    sum_of_rows(TermsOf<Pass>{pass, measure_.counts().total, {}}, measure_.terms(), terms);
    join(terms);
    return {counts, terms};
  }

  /// See CpuExec.
  template <class Pass>
  const std::vector<std::int64_t>& count_in_bins(int n, int bins, const Pass& pass) {
    before_waiting();
    return bin_counts_.of(n, bins, pass, launcher_.ready());
  }

  template <class Pass>
  std::uint64_t sum_of(int n, const Pass& pass) {
    const auto term = thrust::make_transform_iterator(thrust::counting_iterator<int>(0), pass);
    unsigned long long sum = 0;
    if (n == 0) return sum;
    sum_.resize(1);
    with_scratch(scratch_, [&](void* scratch, std::size_t& bytes) {
      return cub::DeviceReduce::Sum(scratch, bytes, term, sum_.data(), n, launcher_.ready());
    });
    to_host(sum_.data(), 1, &sum);
    return sum;
  }
  std::size_t bytes() const { return measure_.bytes() + bin_counts_.bytes(); }

 protected:
  template <class... P, class... A>
  void launch(void (*kernel)(P...), int threads, int block, std::size_t shared, const A&... args) {
    launcher_.start(kernel, threads, block, shared, args...);
  }

  const std::int64_t total_, rows_;

 private:
  MeasureSpace measure_;
  BinCounts bin_counts_;
  DeviceBuffer<unsigned long long> sum_;
  DeviceBuffer<char> scratch_;
};

}  // namespace pbf::PBF_VARIANT
