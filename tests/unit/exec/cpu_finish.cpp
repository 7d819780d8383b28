// The work after the sums over neighbors: a group of particles side by side gives the bits of one
// particle at a time, wherever its particles are and whatever their sums are.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "kernels/lane_groups.h"
#include "kernels/pass_delta.h"
#include "kernels/pass_hyperviscosity.h"
#include "kernels/pass_lambda.h"
#include "kernels/pass_xsph.h"
#include "lib/program/simd.h"
#include "tests/support/catch.h"

namespace {

using namespace pbf;

/// No width divides it.
constexpr int kRows = 16 * 40 + 5, kArray = kRows + 16;

/// Numbers of a range, among which are many special ones.
template <class Real>
struct SomeNumbers {
  std::mt19937 bits{7};
  Real operator()(double low, double high) {
    const double x = low + (high - low) * double(bits()) / double(bits.max());
    switch (bits() % 64) {
      case 0:
        return Real(0);
      case 1:
        return -Real(0);
      case 2:
        return Real(low);
      case 3:
        return Real(high);
      case 4:
        return bits() % 8 ? Real(x) : std::numeric_limits<Real>::quiet_NaN();
      case 5:
        return Real(1e18);
      default:
        return Real(x);
    }
  }
};

/// All arrays of the passes, and what they add up.
template <class Real>
struct FinishArrays {
  std::vector<Vec4<Real>> position, velocity, out, free;
  std::vector<Real> density;
  std::vector<int> id = std::vector<int>(kArray), bin = std::vector<int>(kArray);
  std::vector<DissipationSum> taken = std::vector<DissipationSum>(4);
  StepCounts counts;

  explicit FinishArrays(double extent) {
    SomeNumbers<Real> some;
    for (int i = 0; i < kArray; ++i) {
      // Every third group of 16 is away from the walls, the others are at and behind them.
      const double room = i / 16 % 3 == 0 ? 1.5 : -0.2;
      const auto at = [&] {
        return i / 16 % 3 == 0 ? Real(room + (extent - 2 * room) * double(some.bits()) / 0x1p32)
                               : some(room, extent - room);
      };
      position.push_back({at(), at(), at(), i % 50 == 0 ? Real(-1) : some(-0.01, 1)});
      velocity.push_back({some(-90, 90), some(-90, 90), some(-90, 90), Real(0)});
      free.push_back({some(-90, 90), some(-90, 90), some(-90, 90), Real(0)});
      density.push_back(some(0.5, 3));
    }
    out = position;
  }
};

template <class Real, int W, class Pass>
PBF_HD void finish_groups(const Pass& pass, const std::vector<typename Pass::Sum>& sums) {
  using Sum = typename Pass::template SumOf<Lanes<Real, W>>;
  constexpr int parts = sizeof(Sum) / sizeof(Lanes<Real, W>);
  for (int i = 0; i < kRows; i += W) {
    Real one[parts], part[parts * W];
    for (int l = 0; l < W; ++l) {
      std::memcpy(one, &sums[std::size_t(i + l)], sizeof one);
      for (int c = 0; c < parts; ++c) part[c * W + l] = one[c];
    }
    Sum sum;
    std::memcpy(&sum, part, sizeof sum);
    finish_group<W, Real>(pass, i, kRows, pass.own(Adjacent<W>{i}), sum);
  }
}
#ifdef PBF_HAS_AVX
template <class Real, class Pass>
PBF_AVX2 void finish_by_avx2(const Pass& pass, const std::vector<typename Pass::Sum>& sums) {
  finish_groups<Real, 32 / sizeof(Real)>(pass, sums);
}
template <class Real, class Pass>
PBF_AVX512 void finish_by_avx512(const Pass& pass, const std::vector<typename Pass::Sum>& sums) {
  finish_groups<Real, 64 / sizeof(Real)>(pass, sums);
}
#endif
template <class Real, class Pass>
void finish_all(Simd simd, const Pass& pass, const std::vector<typename Pass::Sum>& sums) {
  switch (simd) {
    case Simd::scalar:
      for (int i = 0; i < kRows; ++i) pass.finish(i, pass.own(i), sums[std::size_t(i)]);
      return;
#ifdef PBF_HAS_AVX
    case Simd::avx2:
      return finish_by_avx2<Real>(pass, sums);
    case Simd::avx512:
      return finish_by_avx512<Real>(pass, sums);
#endif
    default:
      return finish_groups<Real, 16 / sizeof(Real)>(pass, sums);
  }
}

/// The same bits, or both NaN: the rules of arithmetic leave the bits of a NaN open.
template <class Real>
bool same_numbers(const Real* a, const Real* b, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k)
    if (std::memcmp(&a[k], &b[k], sizeof(Real)) != 0 && !(std::isnan(a[k]) && std::isnan(b[k])))
      return false;
  return true;
}
template <class Real>
bool same_rows(const std::vector<Vec4<Real>>& a, const std::vector<Vec4<Real>>& b) {
  return same_numbers(&a[0].x, &b[0].x, 4 * a.size());
}
std::int64_t total(const std::vector<DissipationSum>& sums) {
  std::int64_t all = 0;
  for (const DissipationSum& s : sums) all += (s.whole << DissipationSum::bits) + s.rest;
  return all;
}

template <class Real>
Params<Real> some_params(int variant) {
  Params<Real> p;
  p.dt = Real(0.004), p.inv_dt = Real(250), p.back = Real(0.002), p.carry = Real(0.3);
  p.gravity = {Real(0), -Real(0), Real(-30)};
  p.vol = Real(0.125), p.cfm = Real(1e-4), p.sor = Real(0.6), p.xsph = Real(0.02);
  p.damping = Real(0.999), p.under_relax = variant != 1, p.two_sided = variant == 1;
  p.hyperviscosity = Real(0.4), p.calm = Real(0.1);
  p.limit_speed = variant == 2;
  p.speed_squared = Real(6000), p.passing_squared = Real(5000);
  p.boundary.extent = {Real(6), Real(6), Real(6)}, p.boundary.margin = Real(0.1);
  p.boundary.scale = Real(1.21), p.boundary.inv_range = variant == 2 ? Real(1) : Real(1 / 0.7);
  p.boundary.walls = variant == 0 ? 63 : 0b010111;
  p.boundary.adds_density = variant != 3;
  p.cells_x = 12, p.cells_y = 6, p.cells_z = 6;
  return p;
}

/// make(arrays) is a pass that reads and writes these arrays.
template <class Real, class Make>
void check_finish(const Params<Real>& p, const Make& make) {
  FinishArrays<Real> first(double(p.boundary.extent.x));
  using Pass = decltype(make(first));
  constexpr std::size_t parts = sizeof(typename Pass::Sum) / sizeof(Real);
  std::vector<typename Pass::Sum> sums(kArray);
  SomeNumbers<Real> some{std::mt19937{11}};
  for (int i = 0; i < kArray; ++i) {
    Real one[parts];
    for (Real& x : one) x = some(-4, 8);
    // Some groups have a coincident pair.
    if (i / 16 % 5 == 1 && i % 16 == 3) one[parts - 1] = Real(1e15);
    std::memcpy(&sums[std::size_t(i)], one, sizeof one);
  }
  FinishArrays<Real> alone = first;
  finish_all<Real>(Simd::scalar, make(alone), sums);
  CHECK_FALSE((same_rows(alone.out, first.out) && same_rows(alone.velocity, first.velocity) &&
               same_numbers(alone.density.data(), first.density.data(), kArray)));
  for (const Simd simd : usable_simd()) {
    CAPTURE(simd_name(simd), sizeof(Real));
    FinishArrays<Real> together = first;
    finish_all<Real>(simd, make(together), sums);
    CHECK(same_rows(together.out, alone.out));
    CHECK(same_rows(together.velocity, alone.velocity));
    CHECK(same_numbers(together.density.data(), alone.density.data(), kArray));
    CHECK(together.bin == alone.bin);
    CHECK(total(together.taken) == total(alone.taken));
    CHECK(together.counts.unresolved == alone.counts.unresolved);
  }
}

template <class Real, Smoothing S, class Order>
void check_passes(int variant) {
  const auto p = some_params<Real>(variant);
  // Empty lists: the sums are given.
  const int none = 0;
  const int* const chunk[] = {&none};
  const std::vector<ChunkedLists::Group> groups(kArray);
  const ChunkedLists lists{chunk, groups.data(), 0, kArray};
  using Rows = FinishArrays<Real>;
  using Out = OwnRows<Vec4<Real>>;
  using In = GatheredRows<Vec4<Real>>;
  const auto order = [](Rows& a) {
    Order o{};
    if constexpr (Order::second) o.free = a.free.data();
    return o;
  };
  check_finish<Real>(p, [&](Rows& a) {
    return DensityPass<Real, ChunkedLists, S, Box<Real>>{
        p, p.boundary, lists, In(a.position.data()), OwnRows<Real>(a.density.data())};
  });
  check_finish<Real>(p, [&](Rows& a) {
    return LambdaPass<Real, ChunkedLists, S, true, Order, Box<Real>>{
        p,
        p.boundary,
        lists,
        In(a.position.data()),
        Out(a.out.data()),
        OwnRows<Real>(a.density.data()),
        In(a.velocity.data()),
        &a.counts};
  });
  check_finish<Real>(p, [&](Rows& a) {
    return LambdaPass<Real, ChunkedLists, S, false, Order, Box<Real>>{
        p,
        p.boundary,
        lists,
        In(a.position.data()),
        Out(a.out.data()),
        OwnRows<const Real>(a.density.data()),
        In(a.velocity.data()),
        &a.counts};
  });
  for (const bool goes_on : {false, true})
    check_finish<Real>(p, [&](Rows& a) {
      return DeltaPass<Real, ChunkedLists, S, TensilePower::fourth, NoLevelMove<Real>, Order,
                       Box<Real>>{p,
                                  p.boundary,
                                  lists,
                                  In(a.position.data()),
                                  OwnRows<const Real>(a.density.data()),
                                  GatheredRows<int>(a.id.data()),
                                  Out(a.out.data()),
                                  Out(a.velocity.data()),
                                  goes_on ? &a.counts : nullptr,
                                  {},
                                  order(a)};
    });
  check_finish<Real>(p, [&](Rows& a) {
    return XsphPass<Real, ChunkedLists, S, Order, Box<Real>>{
        p,
        p.boundary,
        lists,
        In(a.position.data()),
        In(a.velocity.data()),
        Out(a.out.data()),
        a.bin.data(),
        DissipationBook{a.taken.data(), 3, 0.01},
        order(a)};
  });
  check_finish<Real>(p, [&](Rows& a) {
    return VelocityLaplacianPass<Real, ChunkedLists, S>{
        {p, lists, In(a.position.data()), In(a.velocity.data())}, Out(a.out.data())};
  });
  check_finish<Real>(p, [&](Rows& a) {
    return HyperviscosityPass<Real, ChunkedLists, S>{
        {p, lists, In(a.position.data()), In(a.free.data())},
        Out(a.velocity.data()),
        DissipationBook{a.taken.data(), 3, 0.01}};
  });
}

}  // namespace

TEST_CASE("a group of particles after their sums gives the bits of one particle at a time",
          "[simd]") {
  const int variant = GENERATE(0, 1, 2, 3);
  CAPTURE(variant);
  check_passes<float, Smoothing::consistent, SecondOrder<float>>(variant);
  check_passes<float, Smoothing::paper, FirstOrder>(variant);
  check_passes<float, Smoothing::consistent_2d, SecondOrder<float>>(variant);
  check_passes<float, Smoothing::paper_2d, FirstOrder>(variant);
  check_passes<double, Smoothing::consistent, SecondOrder<double>>(variant);
  check_passes<double, Smoothing::paper_2d, SecondOrder<double>>(variant);
}
