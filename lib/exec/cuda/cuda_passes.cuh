// The launches of passes by their shape: a thread per particle, or several for a neighbor sum where
// there are few particles.
#pragma once

#include <algorithm>

#include "lib/exec/cuda/cuda_sums.cuh"
#include "lib/exec/cuda/kernels.cuh"
#include "lib/exec/cuda/shared_pass.cuh"

namespace pbf::PBF_VARIANT {

class CudaPasses : public CudaSums {
 public:
  using CudaSums::CudaSums;

  template <class Rows, ItemPass Pass>
  void items(const Rows& n, const Pass& pass) {
    launch(item_kernel<Rows, Pass>, most(n), kBlock, 0, n, pass);
  }
  /// The number of threads determines the tree of a neighbor sum, so it follows from the particles
  /// of the whole scene, not from those here.
  template <class Rows, PairPass Pass>
  void pairs(const Rows& n, const Pass& pass) {
    const auto by_one = [&] {
      launch(pair_kernel<Rows, Pass>, most(n), pair_block<Pass>(most(n)), 0, n, pass);
    };
    if constexpr (requires { Pass::of_many; })
      by_one();
    else
      with_lanes<Pass::D>(total_, [&](auto lanes) {
        if constexpr (lanes == 1)
          by_one();
        else
          launch(lanes_kernel<lanes, Rows, Pass>, lanes * most(n), kBlock, 0, n, pass);
      });
  }
  template <SharedPass Pass>
  void shared(int n, const Pass& pass) {
    launch(shared_kernel<Pass>, n * Pass::lanes, kBlock, 0, n, pass);
  }
  template <TeamPass Pass>
  void teams(const Pass& pass) {
    int blocks = 0;
    for (int g = 0; g < pass.groups(); ++g) blocks += team_blocks(pass, g);
    launch(team_kernel<Pass>, blocks * kTeam, kTeam, 0, pass);
  }
  template <BrickPass Pass>
  void bricks(const Pass& pass) {
    bricks(pass, 0, pass.grid.bricks());
  }
  template <BrickPass Pass>
  void bricks(const Pass& pass, int begin, int end) {
    launch(brick_kernel<Pass>, (end - begin) * kBrickBlock<Pass>, kBrickBlock<Pass>, 0, begin,
           pass);
  }
  /// See CpuExec. Their number is known on the device alone.
  template <ItemPass Pass>
  void listed(const int* count, int at_most, const Pass& pass) {
    launch(listed_kernel<Pass>, std::min(at_most, kBlock * kListedBlocks), kBlock, 0, count, pass);
  }

 protected:
  template <class Rows, class Pass>
  void items_or_pairs(const Rows& n, const Pass& pass) {
    if constexpr (PairPass<Pass>)
      pairs(n, pass);
    else
      items(n, pass);
  }
};

}  // namespace pbf::PBF_VARIANT
