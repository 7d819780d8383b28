// Neighbors that were found and are not yet in a list. The threads of a warp find different numbers
// of them in each row of cells. If each wrote its own at once, the others would wait; so they
// collect them in shared memory, and all write words of their lists at the same time.
#pragma once

#include <cuda_runtime.h>

namespace pbf::exec_module {

/// Of one thread. A chunk holds the hits among up to 32 adjacent candidates as bits.
template <int block>
class HitQueue {
 public:
  static constexpr int most = 12;  ///< chunks; nine rows of cells with up to 32 candidates each
  struct Chunk {
    int last;       ///< bit k is row last - k
    unsigned bits;  ///< not 0
  };
  using Memory = Chunk[most][block];  ///< shared; of all threads of a block
  __device__ explicit HitQueue(Memory& memory) : first_(&memory[0][threadIdx.x]), end_(first_) {}

  /// bits: not 0; bit 31 - k is row first + k. Not if the queue is full.
  __device__ __forceinline__ void push(int first, unsigned bits) {
    put({first + 31, bits});
    pending_ += __popc(bits);
  }
  __device__ __forceinline__ bool full() const { return chunk_count_ == most; }
  /// write(word) for all whole words of four hits, in ascending order. all: what is left is
  /// padded with `far` to one more word; the result is the number of entries that this adds.
  template <class Write>
  __device__ __forceinline__ int take_words(bool all, int far, const Write& write) {
    const int rest = pending_ & 3, padded = all && rest ? 4 - rest : 0;
    Chunk now{0, 0};
    const Chunk* from = first_;
    // One loop over entries and not one over chunks, so that threads stay together.
    const auto next = [&] {
      if (now.bits == 0 && from != end_) {
        now = *from;
        from += block;
      }
      const int k = 31 - __clz(int(now.bits));
      const int j = now.bits ? now.last - k : far;
      now.bits &= ~__funnelshift_l(0u, 1u, k);  // 1 << k, defined also for k = -1
      return j;
    };
    for (int words = (pending_ + padded) >> 2; words > 0; --words) {
      int4 word;
      word.x = next();
      word.y = next();
      word.z = next();
      word.w = next();
      write(word);
    }
    if (!all) keep(now, from);
    pending_ = rest;
    return padded;
  }

 private:
  __device__ __forceinline__ void keep(const Chunk& now, const Chunk* from) {
    const Chunk* end = end_;
    end_ = first_;
    chunk_count_ = 0;
    if (now.bits) put(now);
#pragma unroll 1
    for (; from != end; from += block) put(*from);
  }
  __device__ __forceinline__ void put(const Chunk& chunk) {
    *end_ = chunk;
    end_ += block;
    ++chunk_count_;
  }
  Chunk *first_, *end_;  ///< one in `block`
  int chunk_count_ = 0, pending_ = 0;
};

}  // namespace pbf::exec_module
