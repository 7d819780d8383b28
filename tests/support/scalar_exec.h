// The executor of the CPU without vector instructions, which change no bit: a solver of a test's
// own compiles in a fraction of the time.
#pragma once

#include "lib/exec/cpu/cpu_exec.h"

namespace pbf::PBF_VARIANT {

class ScalarExec : public CpuExec {
 public:
  explicit ScalarExec(int threads) : CpuExec(threads, 37, Simd::scalar) {}
  template <PairPass Pass>
  void pairs(int n, const Pass& pass) {
    in_pieces<1>(n, [&](int first, int last) {
      for (int i = first; i < last; ++i) sum_over_neighbors(pass, i);
    });
  }
};

}  // namespace pbf::PBF_VARIANT
