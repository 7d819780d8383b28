// Sums that do not depend on the order of their terms: integers in a common unit.
#pragma once

#include <string.h>

#include <cmath>
#include <cstdint>

#include "kernels/hd.h"

namespace pbf {

/// The sum of up to 2^31 terms t with |t| <= 2^62. The upper parts t >> 31 and the lower 31 bits
/// are summed separately. Each is at most 2^31 in magnitude, so neither sum exceeds 2^62 or
/// overflows 64 bits, and no carry is needed.
struct FixedSum {
  std::int64_t high = 0, low = 0;
  PBF_HD void add(const FixedSum& o) {
    high += o.high;
    low += o.low;
  }
};

/// The exponent e with 2^(e - 1) <= magnitude < 2^e, limited to |e| <= 1000 so that 2^e and 2^-e
/// are normal numbers.
PBF_HD int exponent_above(double magnitude) {
  std::uint64_t bits;
  memcpy(&bits, &magnitude, sizeof bits);
  const int e = int(bits >> 52 & 0x7ff) - 1022;
  return e < -1000 ? -1000 : e > 1000 ? 1000 : e;
}

/// 2^e, |e| <= 1000.
PBF_HD double power_of_two(int e) {
  const std::uint64_t bits = std::uint64_t(1023 + e) << 52;
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/// x, limited to [-1, 1], in units of 2^-62, truncated towards zero; exact for |x| >= 2^-10,
/// because a double has 53 bits.
PBF_HD FixedSum fixed_term(double x) {
  const std::int64_t t = std::int64_t((x < -1 ? -1 : x > 1 ? 1 : x) * 0x1p62);
  return {t >> 31, t & 0x7fffffff};
}

/// The sum, rounded once, where fixed_term(1) stands for 2^e.
inline double value_of(const FixedSum& s, int e) {
  __extension__ typedef __int128 Wide;
  return std::ldexp(double(Wide(s.high) * (Wide(1) << 31) + s.low), e - 62);
}

}  // namespace pbf
