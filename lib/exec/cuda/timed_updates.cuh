// The time that whole updates take on the device.
#pragma once

#include <cuda_runtime.h>

#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::PBF_VARIANT {

class TimedUpdates {
 public:
  TimedUpdates() = default;
  TimedUpdates(const TimedUpdates&) = delete;
  TimedUpdates& operator=(const TimedUpdates&) = delete;
  ~TimedUpdates() {
    for (cudaEvent_t e : {begin_, end_})
      if (e) cudaEventDestroy(e);
  }
  /// Of the update before, which is then done, the time is added.
  template <class Update>
  void add(Launcher& launcher, const Update& update) {
    if (samples_++ > 0) {
      float ms = 0;
      PBF_CUDA_CHECK(cudaEventElapsedTime(&ms, begin_, end_));
      seconds_ += 1e-3 * double(ms);
    } else {
      PBF_CUDA_CHECK(cudaEventCreate(&begin_));
      PBF_CUDA_CHECK(cudaEventCreate(&end_));
    }
    PBF_CUDA_CHECK(cudaEventRecord(begin_, launcher.ready()));
    update();
    PBF_CUDA_CHECK(cudaEventRecord(end_, launcher.ready()));
  }
  /// s of an update; 0: not known yet.
  double mean() const { return samples_ > 1 ? seconds_ / (samples_ - 1) : 0; }

 private:
  double seconds_ = 0;
  int samples_ = 0;
  cudaEvent_t begin_ = nullptr, end_ = nullptr;
};

}  // namespace pbf::PBF_VARIANT
