// The mean compression that decides whether more iterations follow (solver.tolerance). Summed as an
// integer, so the same for any number of threads and in any order.
#pragma once

#include <cstdint>

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

constexpr double kResidualUnit = 0x1p-32;  ///< of one particle's compression
constexpr double kResidualMax = 8;         ///< upper limit: 2^31 particles then fit 64 bits

/// Compression max(rho - 1, 0) in units of kResidualUnit, rounded down. NaN counts as kResidualMax,
/// so that a broken state never passes for a converged one.
template <class Real>
struct ResidualPass {
  const Real* density;  ///< rho0, of the last iteration, before it moved the particles
  PBF_HD std::uint64_t operator()(int i) const {
    const double c = double(density[i]) - 1;
    if (c <= 0) return 0;
    return std::uint64_t((c < kResidualMax ? c : kResidualMax) * (1 / kResidualUnit));
  }
};

/// The largest sum of n particles whose mean is at most `tolerance`.
PBF_HD std::uint64_t residual_limit(double tolerance, int n) {
  const double limit = tolerance / kResidualUnit * n;
  return limit < 0x1p63 ? std::uint64_t(limit) : std::uint64_t(1) << 63;
}

}  // namespace pbf::PBF_VARIANT
