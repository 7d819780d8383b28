// The launch of every kernel, and its first statement.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>
#include <utility>

#include "kernels/hd.h"
#include "kernels/pass_chain.h"
#include "kernels/row_state.h"
#include "lib/exec/cuda/check.h"

namespace pbf::PBF_VARIANT {

constexpr int kBlock = 128;

/// The rows of a launch, whose number the host or the device knows: for how many threads to launch,
/// and in a kernel the first row and the end. A kernel asks before wait_for_previous(), which hides
/// the load: see CudaExec::rows_changed().
inline int most(int n) { return n; }
/// The threads of a warp have adjacent rows from a multiple of 32 on: those of some other range
/// would touch more lines of memory.
PBF_HD constexpr int aligned(const RowRange& rows) { return rows.first & ~31; }
inline int most(const RowRange& rows) { return rows.last - aligned(rows); }
__device__ __forceinline__ int first_of(int) { return 0; }
__device__ __forceinline__ int first_of(const RowRange& rows) { return aligned(rows); }
__device__ __forceinline__ int end_of(int n) { return n; }
__device__ __forceinline__ int end_of(const RowRange& rows) {
  return rows.state ? int(rows.state->rows) : rows.last;
}

/// Rows *first ... *last - 1, numbers on the device; at most `most`. What was launched last must
/// have written them, and the launch is alone.
struct RowsBetween {
  const int *first, *last;
  int most;
};
inline int most(const RowsBetween& rows) { return rows.most; }
__device__ __forceinline__ int first_of(const RowsBetween& rows) { return *rows.first & ~31; }
__device__ __forceinline__ int end_of(const RowsBetween& rows) { return *rows.last; }

/// Whether a launch leaves out row i, which is below the end.
__device__ __forceinline__ bool leaves_out(int, int) { return false; }
__device__ __forceinline__ bool leaves_out(const RowsBetween& rows, int i) {
  return i < *rows.first;
}
__device__ __forceinline__ bool leaves_out(const RowRange& rows, int i) {
  return i < rows.first || rows.leaves_out(i);
}

/// First statement of every kernel, but for end_of(). A kernel is set up while the previous one
/// ends, and waits here until that one is done (programmatic dependent launch, from sm_90 on). An
/// explicit early trigger is slower: its blocks would occupy places that blocks of the previous
/// kernel need (kernels/PERFORMANCE.md).
__device__ __forceinline__ void wait_for_previous() {
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}

/// The kernel behind may be set up, and run up to its wait_for_previous(), from now on.
__device__ __forceinline__ void let_next_begin() {
#if __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
#endif
}
/// First statements of the kernel of a pass (kernels/pass_chain.h). A kernel begins when all blocks
/// of the one before it let it or have ended, so all that its blocks wait for runs. off(), for a
/// pass with is_off(): whether this thread needs nothing of the passes in front, whose results
/// off() does not read. A block whose threads are all off does not wait, and makes room for others.
/// The first block always waits, so that the kernel does not end before these passes.
template <class Pass, class Off>
__device__ __forceinline__ void begin_pass(const Off& off) {
  if constexpr (chain_of<Pass>() == Chain::inner) let_next_begin();
  bool waits = !finish_waits<Pass>();
  if constexpr (requires { &Pass::is_off; }) waits = !__syncthreads_and(off()) || blockIdx.x == 0;
  if (waits) wait_for_previous();
  if constexpr (chain_of<Pass>() == Chain::first) let_next_begin();
}
template <class Pass>
__device__ __forceinline__ void begin_pass() {
  begin_pass<Pass>([] { return false; });
}
template <class Pass, class Own, class Sum>
__device__ __forceinline__ void finish_pass(const Pass& pass, int i, const Own& own,
                                            const Sum& sum) {
  if constexpr (finish_waits<Pass>()) wait_for_previous();
  pass.finish(i, own, sum);
}
/// Last statement of the kernel of a neighbor sum: threads without a row wait too, so that it does
/// not end before the passes beside it.
template <class Pass>
__device__ __forceinline__ void end_pass() {
  if constexpr (finish_waits<Pass>()) wait_for_previous();
}

/// Launches kernels on a stream: one after the other, each with programmatic dependent launch, if
/// the device has it, which hides most of the time between two kernels.
struct Launcher {
  cudaStream_t stream = nullptr;
  bool overlap = false;           ///< the device has programmatic dependent launch
  bool alone = false;             ///< the next launch does without
  cudaEvent_t awaited = nullptr;  ///< what is next launched, other than by EdgeStream, waits for it
  cudaEvent_t arrived = nullptr;  ///< not null: to be recorded before the stream waits for that
  bool split = false;             ///< nothing else was launched since EdgeStream::beside()

  void note_arrival() {
    if (arrived) PBF_CUDA_CHECK(cudaEventRecord(arrived, stream));
    arrived = nullptr;
  }
  /// The stream for anything that needs all that was launched before.
  cudaStream_t ready() {
    split = false;
    if (awaited) {
      note_arrival();
      PBF_CUDA_CHECK(cudaStreamWaitEvent(stream, awaited, 0));
      awaited = nullptr;
      alone = true;
    }
    return stream;
  }

  /// Enough blocks of `block` threads for `threads`.
  template <class... P, class... A>
  void start(void (*kernel)(P...), int threads, int block, std::size_t shared, const A&... args) {
    if (threads == 0) return;
    const auto blocks = unsigned((std::int64_t(threads) + block - 1) / block);
    start_blocks(kernel, blocks, block, shared, false, args...);
  }
  /// Blocks that all run at the same time.
  template <class... P, class... A>
  void start_together(void (*kernel)(P...), int blocks, int block, std::size_t shared,
                      const A&... args) {
    start_blocks(kernel, unsigned(blocks), block, shared, true, args...);
  }

  /// Launches what needs nothing of what is awaited.
  void meanwhile(const auto& launches) {
    const cudaEvent_t others = std::exchange(awaited, nullptr);
    launches();
    awaited = others;
  }

 private:
  template <class... P, class... A>
  void start_blocks(void (*kernel)(P...), unsigned blocks, int block, std::size_t shared,
                    bool together, const A&... args) {
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(blocks);
    config.blockDim = dim3(unsigned(block));
    config.dynamicSmemBytes = shared;
    config.stream = ready();
    cudaLaunchAttribute attributes[2]{};
    config.attrs = attributes;
    if (overlap && !alone) {
      cudaLaunchAttribute& dependent = attributes[config.numAttrs++];
      dependent.id = cudaLaunchAttributeProgrammaticStreamSerialization;
      dependent.val.programmaticStreamSerializationAllowed = 1;
    }
    if (together) {
      cudaLaunchAttribute& cooperative = attributes[config.numAttrs++];
      cooperative.id = cudaLaunchAttributeCooperative;
      cooperative.val.cooperative = 1;
    }
    alone = false;
    PBF_CUDA_CHECK(cudaLaunchKernelEx(&config, kernel, P(args)...));
  }
};

}  // namespace pbf::PBF_VARIANT
