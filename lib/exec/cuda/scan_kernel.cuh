// Sums of all numbers before each, in one launch: for as many bins as the blocks that a device runs
// at once can hold.
#pragma once

#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::PBF_VARIANT {

/// What a block of the scan has told others; 0: nothing yet.
using ScanTile = unsigned long long;
enum ScanState : unsigned { scan_own = 1, scan_all = 2 };  ///< its own sum; that of all before, too
constexpr int kScanBlock = 512, kScanItems = 8, kScanTile = kScanBlock * kScanItems;

__device__ __forceinline__ void tell(ScanTile* tile, int sum, ScanState state) {
  *static_cast<volatile ScanTile*>(tile) = ScanTile(unsigned(sum)) << 2 | state;
}
/// One warp of block `me` adds what the blocks before it have told, beginning with the last, back
/// to one that knows all before itself.
__device__ __forceinline__ int sum_before(ScanTile* tile, int me) {
  const int lane = threadIdx.x % 32;
  int sum = 0;
  for (int last = me - 1; last >= 0; last -= 32) {
    ScanTile told = scan_all;
    if (const int k = last - lane; k >= 0)
      while (!(told = *static_cast<volatile ScanTile*>(tile + k))) {
      }
    const unsigned whole = __ballot_sync(0xffffffffu, (told & 3) == scan_all);
    int part = !whole || lane < __ffs(int(whole)) ? int(told >> 2) : 0;
    for (int d = 16; d > 0; d /= 2) part += __shfl_xor_sync(0xffffffffu, part, d);
    sum += part;
    if (whole) break;
  }
  return sum;
}

/// to[k] = from[0] + ... + from[k - 1] for k < n, by decoupled look-back (Merrill & Garland 2016,
/// "Single-pass parallel prefix scan with decoupled look-back"). tile: zeros, one for each block.
/// All blocks must run at once, because they wait for each other.
template <int block>
__global__ void __launch_bounds__(block)
    scan_kernel(const int* from, int n, int* to, ScanTile* tile) {
  constexpr int warps = block / 32;
  static_assert(warps <= 32);
  __shared__ int of_warp[warps], base;
  const int warp = int(threadIdx.x) / 32, lane = threadIdx.x % 32, me = blockIdx.x;
  const int first = (me * block + int(threadIdx.x)) * kScanItems;
  wait_for_previous();
  int value[kScanItems], sum = 0;
  for (int k = 0; k < kScanItems; ++k) {
    value[k] = first + k < n ? from[first + k] : 0;
    sum += value[k];
  }
  const auto up_to_lane = [&](int x) {
    for (int d = 1; d < 32; d *= 2) {
      const int other = __shfl_up_sync(0xffffffffu, x, d);
      if (lane >= d) x += other;
    }
    return x;
  };
  const int up_to_me = up_to_lane(sum);
  if (lane == 31) of_warp[warp] = up_to_me;
  __syncthreads();
  if (warp == 0) {
    const int mine = lane < warps ? of_warp[lane] : 0, up_to = up_to_lane(mine);
    if (lane < warps) of_warp[lane] = up_to - mine;
    const int all = __shfl_sync(0xffffffffu, up_to, 31);
    if (lane == 0) tell(tile + me, all, me == 0 ? scan_all : scan_own);
    const int before = sum_before(tile, me);
    if (lane == 0 && me > 0) tell(tile + me, before + all, scan_all);
    if (lane == 0) base = before;
  }
  __syncthreads();
  int at = base + of_warp[warp] + up_to_me - sum;
  for (int k = 0; k < kScanItems; ++k) {
    if (first + k < n) to[first + k] = at;
    at += value[k];
  }
}

}  // namespace pbf::PBF_VARIANT
