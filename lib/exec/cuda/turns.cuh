// Lists, lambda and delta of all iterations, and XSPH behind them, in one kernel, for few
// particles: there a pass takes less time than its launch and the loads of its own row and list,
// which here stay in registers.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <span>
#include <type_traits>
#include <utility>

#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/kept_row.cuh"
#include "lib/exec/cuda/kernels.cuh"
#include "lib/exec/cuda/list_pass.cuh"
#include "lib/program/turns.h"

namespace pbf::PBF_VARIANT {

constexpr int kTurnThreads = 768;  ///< most in a block: more would have too few registers

/// All blocks of a launch wait for each other. *arrived: 0 at first, and counts the blocks in its
/// lower bits; each time all have arrived, its highest bit changes.
class GridBarrier {
 public:
  /// arrived: null if nobody waits.
  __device__ explicit GridBarrier(unsigned* arrived)
      : arrived_(arrived), side_(arrived && threadIdx.x == 0 ? look() & kSide : 0) {}
  __device__ __forceinline__ void wait() {
    __syncthreads();
    if (threadIdx.x == 0) {
      const unsigned mine = blockIdx.x == 0 ? kSide - (gridDim.x - 1) : 1;
      asm volatile("red.release.gpu.global.add.u32 [%0], %1;" ::"l"(arrived_), "r"(mine)
                   : "memory");
      while ((look() & kSide) == side_) {
      }
    }
    side_ ^= kSide;
    __syncthreads();
  }

 private:
  static constexpr unsigned kSide = 0x80000000u;
  __device__ __forceinline__ unsigned look() const {
    unsigned now;
    asm volatile("ld.acquire.gpu.global.u32 %0, [%1];" : "=r"(now) : "l"(arrived_) : "memory");
    return now;
  }
  unsigned* arrived_;
  unsigned side_;
};

/// What a launch does: all of it, without XSPH if another pass comes first, or lambda or delta
/// alone, with the same bits.
struct TurnParts {
  bool lists, lambda, delta, xsph;
};

template <class Lambda, class Delta, class Xsph>
struct Turns {
  TurnParts parts;
  ListPass<float, 3, false> lists;
  Lambda lambda;
  Delta delta;
  Xsph xsph;
  Arrivals<false> arrivals;  ///< of the bins that XSPH finds; without `count` for a later pass
  int times;
  float factor[kMostTurns];  ///< omega of each iteration
  unsigned* arrived;         ///< of GridBarrier
};

/// One pass for the particle that `lanes` threads share. The first of them writes the results.
template <int lanes, class Pass>
__device__ __forceinline__ void take_turn(const Pass& pass, const KeptEntries<lanes>& entries,
                                          KeptRow& kept, int lane, bool valid) {
  const auto own = pass.own(Kept{&kept});
  typename Pass::Sum sum{};
  entries.add_to(pass, own, sum);
  sum.each([](auto& x) {
#pragma unroll
    for (int half = lanes / 2; half > 0; half /= 2) x += __shfl_xor_sync(0xffffffffu, x, half);
  });
  if (valid && lane == 0) pass.finish(Kept{&kept}, own, sum);
}
/// That of the first of `lanes` threads.
template <int lanes>
__device__ __forceinline__ Vec4<float> of_first(const Vec4<float>& mine) {
  const auto get = [](float x) { return __shfl_sync(0xffffffffu, x, 0, lanes); };
  return {get(mine.x), get(mine.y), get(mine.z), get(mine.w)};
}

/// Of shared memory for a list in the making; one more than needed, against bank conflicts.
constexpr int kStageWords = ListPass<float, 3>::staged / 4 + 1;

template <int lanes, class Lambda, class Delta, class Xsph>
__global__ void __launch_bounds__(kTurnThreads, 1)
    turns_kernel(RowRange rows, const __grid_constant__ Turns<Lambda, Delta, Xsph> t) {
  extern __shared__ int4 stages[];
  const int n = end_of(rows);
  wait_for_previous();
  const bool all = t.parts.lambda && t.parts.delta;
  GridBarrier barrier(all ? t.arrived : nullptr);
  const int thread = blockIdx.x * blockDim.x + threadIdx.x;
  const int i = first_of(rows) + thread / lanes, lane = thread % lanes;
  const bool valid = i < n && !leaves_out(rows, i);
  const ChangingLists& lists = t.lambda.lists;
  MadeList list{0, nullptr};
  int* stage = nullptr;
  if (t.parts.lists) {
    stage = reinterpret_cast<int*>(stages + kStageWords * (threadIdx.x / lanes));
    list = t.lists.template by_group<lanes>(i, lane, valid, stage);
    __syncwarp();
  } else if (valid) {
    list = {lists.count[i], lists.overflow_words(i, lists.count[i])};
  }
  const KeptEntries<lanes> entries(lists, i, lane, valid ? list.count : 0, list.overflow, stage);

  KeptRow kept{};
  kept.i = i;
  kept.position_rows = t.lambda.position.rows();
  kept.velocity_rows = t.lambda.velocity.rows();
  kept.direction_rows = t.delta.position.rows();
  if (valid) {
    kept.position = kept.position_rows[i];
    kept.velocity = kept.velocity_rows[i];
    if (!t.parts.lambda) {
      kept.direction = kept.direction_rows[i];
      kept.density = t.delta.density.rows()[i];
    }
  }
  for (int k = 0; k < t.times; ++k) {
    if (k > 0) barrier.wait();
    if (t.parts.lambda) {
      take_turn(t.lambda, entries, kept, lane, valid);
      kept.direction = of_first<lanes>(kept.direction);
    }
    if (!t.parts.delta) break;
    if (all) barrier.wait();
    Delta delta = t.delta;
    delta.p.sor = t.factor[k];
    take_turn(delta, entries, kept, lane, valid);
    kept.position = of_first<lanes>(kept.position);
  }
  const bool writes = valid && lane == 0;
  if (writes && t.parts.lambda) t.lambda.density.rows()[i] = kept.density;
  if (writes && t.parts.delta) t.delta.velocity.rows()[i] = kept.velocity;
  if (!t.parts.xsph) return;
  kept.velocity = of_first<lanes>(kept.velocity);
  barrier.wait();
  take_turn(t.xsph, entries, kept, lane, valid);
  if (writes && t.arrivals.count) t.arrivals.add(t.xsph.bin, i);
}

/// Launches turns_kernel for all iterations where all its blocks can run at the same time.
class TurnLauncher {
 public:
  TurnLauncher() { ++launchers; }
  ~TurnLauncher() { --launchers; }
  TurnLauncher(const TurnLauncher&) = delete;

  void prepare(int device, cudaStream_t stream) {
    PBF_CUDA_CHECK(cudaDeviceGetAttribute(&processors_, cudaDevAttrMultiProcessorCount, device));
    PBF_CUDA_CHECK(cudaDeviceGetAttribute(&cooperative_, cudaDevAttrCooperativeLaunch, device));
    arrived_.resize(1);
    PBF_CUDA_CHECK(cudaMemsetAsync(arrived_.data(), 0, arrived_.bytes(), stream));
  }
  /// Whether all blocks for so many rows can run at the same time. Not where solvers share a
  /// process and a device either: each would wait with all of it, while kernels of single passes
  /// run beside each other. total: particles of the whole scene.
  template <class Lambda, class Delta, class Xsph>
  bool fits(std::int64_t total, const RowRange& rows) {
    bool all = false;
    with_turn_lanes(total, [&](auto lanes) {
      all = cooperative_ && launchers == 1 &&
            fits<Lambda, Delta, Xsph>(lanes, blocks_for(lanes, rows));
    });
    return all;
  }
  /// All turns in one launch, after fits().
  template <class Lambda, class Delta, class Xsph>
  void all(Launcher& launcher, std::int64_t total, const RowRange& rows,
           Turns<Lambda, Delta, Xsph> turns) {
    turns.arrived = arrived_.data();
    with_turn_lanes(total, [&](auto lanes) {
      const auto [blocks, threads] = blocks_for(lanes, rows);
      launcher.start_together(turns_kernel<lanes, Lambda, Delta, Xsph>, blocks, threads,
                              shared_for(lanes, threads), rows, turns);
    });
  }
  /// Lambda or delta alone, with the bits of all().
  template <class Lambda, class Delta, class Xsph>
  void one(Launcher& launcher, std::int64_t total, const RowRange& rows,
           const Turns<Lambda, Delta, Xsph>& turns) {
    with_turn_lanes(total, [&](auto lanes) {
      launcher.start(turns_kernel<lanes, Lambda, Delta, Xsph>, lanes * most(rows), kBlock, 0, rows,
                     turns);
    });
  }

 private:
  template <class F>
  static void with_turn_lanes(std::int64_t total, const F& f) {
    with_lanes<3>(total, [&](auto lanes) {
      if constexpr (lanes >= 4) f(lanes);  // kMostInTurns
    });
  }
  struct Blocks {
    int count, threads;
  };
  Blocks blocks_for(int lanes, const RowRange& rows) const {
    const std::int64_t threads = std::int64_t(lanes) * most(rows);
    const std::int64_t each = (threads + processors_ - 1) / processors_;
    const int block = int(std::max<std::int64_t>((each + 31) / 32 * 32, kBlock));
    return {int((threads + block - 1) / block), block};
  }
  template <class Lambda, class Delta, class Xsph, class Lanes>
  bool fits(Lanes lanes, const Blocks& blocks) {
    if (blocks.threads > kTurnThreads) return false;
    const auto kernel = &turns_kernel<lanes, Lambda, Delta, Xsph>;
    const auto [fits, is_new] =
        fits_.try_emplace({reinterpret_cast<const void*>(kernel), blocks.threads}, 0);
    if (is_new) {
      // The same number for all solvers of a process: it belongs to the kernel.
      PBF_CUDA_CHECK(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                          int(shared_for(lanes, kTurnThreads))));
      PBF_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(
          &fits->second, kernel, blocks.threads, shared_for(lanes, blocks.threads)));
    }
    return std::int64_t(fits->second) * processors_ >= blocks.count;
  }

  static std::size_t shared_for(int lanes, int block) {
    return sizeof(int4) * std::size_t(kStageWords * (block / lanes));
  }

  static inline std::atomic<int> launchers = 0;      ///< in this process
  std::map<std::pair<const void*, int>, int> fits_;  ///< blocks of a kernel and size per processor
  int processors_ = 0, cooperative_ = 0;
  DeviceBuffer<unsigned> arrived_;
};

}  // namespace pbf::PBF_VARIANT
