#pragma once

#include <algorithm>
#include <vector>

#include "kernels/compression_bins.h"

namespace pbf::PBF_VARIANT {

/// A compression that at least `count` of n particles do not exceed: the upper end of a bin of the
/// histogram, thus at most 1/32 too large, and at most the maximum.
inline double compression_percentile(const std::vector<std::int64_t>& in_bin, std::int64_t count,
                                     std::int64_t n, double max) {
  std::int64_t above = 0;
  for (int b = kCompressionBins - 1; b >= 0; --b) {
    above += in_bin[std::size_t(b)];
    if (n - above < count) return std::min(compression_bin_end(b), max);
  }
  return 0;
}

}  // namespace pbf::PBF_VARIANT
