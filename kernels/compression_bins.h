// The fixed logarithmic histogram of compression, from which a run computes its 99th percentile. It
// counts integers, so it is the same on every backend and for any number of threads.
#pragma once

#include <string.h>

#include <cstdint>

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

/// 32 bins per factor of 2, from 2^-24 (6e-8) to 2^8; larger values count in the last bin.
constexpr int kCompressionBins = 1024;
constexpr int kBinShift = 18;               ///< dropped bits of a float; exponent and 5 bits remain
constexpr int kFirstBin = (127 - 24) * 32;  ///< the remaining bits of 2^-24
constexpr double kLowestBinned = 0x1p-24;

/// Bin of c = max(rho/rho0 - 1, 0); -1 below the first bin, which counts as no compression.
PBF_HD int compression_bin(double c) {
  if (!(c >= kLowestBinned)) return -1;
  const float f = float(c < 255 ? c : 255);
  std::uint32_t bits;
  memcpy(&bits, &f, sizeof bits);
  const int bin = int(bits >> kBinShift) - kFirstBin;
  return bin < kCompressionBins ? bin : kCompressionBins - 1;
}

/// Upper end of a bin: at most 1/32 above any value in it.
PBF_HD double compression_bin_end(int bin) {
  const std::uint32_t bits = std::uint32_t(bin + 1 + kFirstBin) << kBinShift;
  float f;
  memcpy(&f, &bits, sizeof f);
  return double(f);
}

/// The bin of a particle, from its density in units of rho0.
template <class Real>
struct CompressionBinPass {
  const Real* density;
  PBF_HD int operator()(int i) const { return compression_bin(double(density[i]) - 1); }
};

}  // namespace pbf::PBF_VARIANT
