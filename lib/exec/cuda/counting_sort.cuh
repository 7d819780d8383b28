// The counting sort by bin on a device.
#pragma once

#include <cub/device/device_scan.cuh>

#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/sort_kernels.cuh"

namespace pbf::PBF_VARIANT {

/// Counts the rows of each bin as they get their bins, and then places them; BinSort::order holds
/// the order of arrival within bins.
class CountingSort {
 public:
  void begin(const BinSort& s, std::int64_t rows, Launcher& launcher) {
    slot_.resize(std::size_t(rows));
    if (counts_.size() == std::size_t(s.all) + 1) return;
    counts_.resize(std::size_t(s.all) + 1);
    PBF_CUDA_CHECK(cudaMemsetAsync(counts_.data(), 0, counts_.bytes(), launcher.ready()));
    launcher.alone = true;
  }
  template <bool leave, class Pass>
  CountPass<leave, Pass> counting(const BinSort& s, const Pass& pass) {
    return {pass, arrivals<leave>(s)};
  }
  template <bool leave>
  Arrivals<leave> arrivals(const BinSort& s) {
    return {s.bins, counts_.data(), s.order, s.id};
  }
  /// Bins become places. The counts are those for the next sort.
  template <class Rows>
  void place(Launcher& launcher, const BinSort& s, const int* bin, const Rows& n,
             ListState* lists) {
    scan(s.bins, s.start, launcher.ready());
    launcher.start(place_kernel<Rows>, most(n), kBlock, 0, n,
                   PlacePass{s.bins, bin, s.id, s.start, s.order, slot_.data(), counts_.data()},
                   lists);
  }
  /// All of a sort whose passes before this one have given rows their bins, or whose `first` does.
  template <bool leave, class Rows, class First, class Gather>
  void small(Launcher& launcher, const BinSort& s, std::int64_t rows, const Rows& n,
             const First& first, ListState* lists, const Gather& gather) {
    const auto kernel = &small_sort_kernel<leave, Rows, First, Gather>;
    const std::size_t shared = (std::size_t(s.all) + 1 + std::size_t(rows)) * sizeof(int);
    launcher.start(kernel, kSortThreads, kSortThreads, shared, n, first, s.all, s.start, lists,
                   in_order<leave>(s, first.bin, gather));
  }
  template <bool leave, class Gather>
  OrderPass<leave, Gather> in_order(const BinSort& s, const int* bin, const Gather& gather) {
    return {s.bins, bin, s.id, s.start, slot_.data(), gather};
  }
  std::size_t bytes() const { return counts_.bytes() + slot_.bytes() + scan_.bytes(); }

 private:
  /// Exclusive sums of the counts.
  void scan(const BinRange& bins, int* start, cudaStream_t stream);

  DeviceBuffer<int> counts_, slot_;
  DeviceBuffer<char> scan_;  ///< separate, because recorded updates hold its address
};

}  // namespace pbf::PBF_VARIANT
