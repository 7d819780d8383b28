// The artificial pressure between particles almost h apart, which is 0.
#include <cstring>
#include <random>

#include "kernels/lane_groups.h"
#include "kernels/pass_delta.h"
#include "lib/program/simd.h"
#include "lib/solver/params.h"
#include "tests/support/catch.h"

namespace {

using namespace pbf;
using TensilePass = DeltaPass<float, ChunkedLists, Smoothing::consistent, TensilePower::any,
                              NoLevelMove<float>, FirstOrder, Box<float>>;
constexpr int kLanes = 16, kPairs = 30;

/// A particle per lane, and its neighbors.
struct TensilePairs {
  Vec4<float> own[kLanes], other[kPairs][kLanes];
};
template <int W>
PBF_HD void add_pairs(const TensilePass& pass, const TensilePairs& pairs, int first, float* out) {
  using V = Lanes<float, W>;
  const auto rows = [&](const Vec4<float>* a) {
    return transposed<float, W>(a + first, Adjacent<W>{0});
  };
  typename TensilePass::SumOf<V> sum{};
  const Vec4<V> own = rows(pairs.own);
  for (int k = 0; k < kPairs; ++k) pass.add(sum, own, rows(pairs.other[k]));
  for (const V& x : {sum.move.x, sum.move.y, sum.move.z}) x.to(out + first), out += kLanes;
}
#ifdef PBF_HAS_AVX
PBF_AVX2 void add_by_avx2(const TensilePass& pass, const TensilePairs& pairs, float* out) {
  for (int l = 0; l < kLanes; l += 8) add_pairs<8>(pass, pairs, l, out);
}
PBF_AVX512 void add_by_avx512(const TensilePass& pass, const TensilePairs& pairs, float* out) {
  add_pairs<16>(pass, pairs, 0, out);
}
#endif
void add_together(Simd simd, const TensilePass& pass, const TensilePairs& pairs, float* out) {
#ifdef PBF_HAS_AVX
  if (simd == Simd::avx512) return add_by_avx512(pass, pairs, out);
  if (simd == Simd::avx2) return add_by_avx2(pass, pairs, out);
#endif
  for (int l = 0; l < kLanes; l += 4) add_pairs<4>(pass, pairs, l, out);
}

}  // namespace

TEST_CASE("pairs at the end of the artificial pressure give the bits of one pair at a time",
          "[simd]") {
  TensilePass pass{};
  Params<float>& p = pass.p;
  p.tensile_k = GENERATE(1e-3f, 1e-2f, 1.0f, 1000.0f);
  p.tensile_n = GENERATE(1, 3, 4, 7);
  p.tensile_scale = GENERATE(1.01f, 2.9f, 1e4f);
  p.vol = 0.125f;
  p.tensile_from = float(least_tensile(p.tensile_n));
  CAPTURE(p.tensile_k, p.tensile_n, p.tensile_scale, p.tensile_from);
  std::mt19937 bits{5};
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * double(bits()) / 0x1p32;
  };
  // A tiny sum of two lambdas, none, and usual ones.
  const auto lambda = [&] {
    const float some[] = {0, -0.0f, -0x1p-99f, -1e-12f, -float(uniform(0, 0.01))};
    return some[bits() % 5];
  };
  int omitted = 0;
  for (int round = 0; round < 200; ++round) {
    TensilePairs pairs;
    const bool idle = round % 2 == 0;  // no particle is compressed: the sum is of tiny terms alone
    for (int l = 0; l < kLanes; ++l) pairs.own[l] = {4, 4, 4, idle ? -0.0f : lambda()};
    for (auto& row : pairs.other)
      for (int l = 0; l < kLanes; ++l) {
        const double q = 1 - std::pow(2, uniform(-24, -1));
        Vec3<double> d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        if (bits() % 4 == 0) d = {1, 0, 0};
        const double scale = q / std::sqrt(dot(d, d));
        row[l] = {float(4 + scale * d.x), float(4 + scale * d.y), float(4 + scale * d.z),
                  idle ? -0.0f : lambda()};
        const double t = 1 - q;
        omitted += t * t * t * double(p.tensile_scale) < double(p.tensile_from);
      }
    float alone[3 * kLanes], together[3 * kLanes];
    for (int l = 0; l < kLanes; ++l) {
      TensilePass::Sum sum{};
      for (const auto& row : pairs.other) pass.add(sum, pairs.own[l], row[l]);
      alone[l] = sum.move.x, alone[kLanes + l] = sum.move.y, alone[2 * kLanes + l] = sum.move.z;
    }
    for (const Simd simd : usable_simd()) {
      add_together(simd, pass, pairs, together);
      CAPTURE(simd_name(simd), round);
      REQUIRE(std::memcmp(alone, together, sizeof alone) == 0);
    }
  }
  if (p.tensile_n >= 4 && p.tensile_scale < 10) CHECK(omitted > 1000);
}
