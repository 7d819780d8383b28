// Counts how many particles a pass puts into each of some bins.
#pragma once

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <cub/device/device_histogram.cuh>
#include <vector>

#include "lib/exec/cuda/device_buffer.h"

namespace pbf::PBF_VARIANT {

class BinCounts {
 public:
  /// Waits for the device.
  template <class Pass>
  const std::vector<std::int64_t>& of(int n, int bins, const Pass& pass, cudaStream_t stream) {
    counts_.resize(std::size_t(bins));
    host_.resize(std::size_t(bins));
    PBF_CUDA_CHECK(cudaMemsetAsync(counts_.data(), 0, counts_.bytes(), stream));
    const auto bin = thrust::make_transform_iterator(thrust::counting_iterator<int>(0), pass);
    if (n > 0)
      with_scratch(scratch_, [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceHistogram::HistogramEven(scratch, bytes, bin, counts_.data(), bins + 1, 0,
                                                   bins, n, stream);
      });
    PBF_CUDA_CHECK(cudaMemcpyAsync(host_.data(), counts_.data(), counts_.bytes(),
                                   cudaMemcpyDeviceToHost, stream));
    PBF_CUDA_CHECK(cudaStreamSynchronize(stream));
    result_.assign(host_.data(), host_.data() + bins);
    return result_;
  }
  std::size_t bytes() const { return counts_.bytes() + scratch_.bytes(); }

 private:
  DeviceBuffer<unsigned long long> counts_;
  DeviceBuffer<char> scratch_;
  PinnedBuffer<unsigned long long> host_;
  std::vector<std::int64_t> result_;
};

}  // namespace pbf::PBF_VARIANT
