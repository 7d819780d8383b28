// Sums that do not depend on the order of their terms: integers, in a unit common to all of them.
#pragma once

#include <string.h>

#include <cmath>
#include <cstdint>

#include "kernels/hd.h"

namespace pbf {

/// The sum of up to 2^31 terms t of |t| <= 2^62: their upper parts t >> 31 and their lower 31 bits,
/// each added by itself. An upper part is at most 2^31 in size, a lower one less, so neither sum
/// leaves 64 bits (2^31 * 2^31 = 2^62), whatever the terms are, and no carry is ever needed.
struct FixedSum {
  std::int64_t high = 0, low = 0;
  PBF_HD void add(const FixedSum& o) {
    high += o.high;
    low += o.low;
  }
};

/// e with magnitude < 2^e, and at least 2^(e - 1) for what lies between 2^-1000 and 2^1000; e stays
/// within these bounds, so that 2^e and 2^-e are normal numbers.
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

/// A term of |x| <= 1 in units of 2^-62, cut off towards zero: exact down to 2^-10, for a double
/// has 53 bits. What is larger counts as 1.
PBF_HD FixedSum fixed_term(double x) {
  const std::int64_t t = std::int64_t((x < -1 ? -1 : x > 1 ? 1 : x) * 0x1p62);
  return {t >> 31, t & 0x7fffffff};
}

/// The sum as a number, rounded once, where x = 1 stood for 2^e.
inline double value_of(const FixedSum& s, int e) {
  __extension__ typedef __int128 Wide;
  return std::ldexp(double(Wide(s.high) * (Wide(1) << 31) + s.low), e - 62);
}

}  // namespace pbf
