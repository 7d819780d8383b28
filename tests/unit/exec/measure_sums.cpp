// The sums of a measure: no order, no overflow, and the digits of a sum in long double.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "lib/exec/cpu/cpu_exec.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

/// Stands for neighbor lists, of which a measure takes the lengths alone.
struct Lengths {
  const int* length;
  int size(int i) const { return length[i]; }
};

template <class Real>
struct TestRows {
  std::vector<Vec4<Real>> position, velocity;
  std::vector<Real> density;
  std::vector<int> length;
  Params<Real> p;
  MeasureConstants given;

  MeasureSums measure(int threads) const {
    CpuExec exec(threads);
    const StepCounts counts;
    return exec.reduce(int(density.size()), MeasurePass<Real, Lengths, Box<Real>>{p,
                                                                                  p.boundary,
                                                                                  {length.data()},
                                                                                  position.data(),
                                                                                  velocity.data(),
                                                                                  density.data(),
                                                                                  &counts,
                                                                                  given});
  }
  TestRows in_order(const std::vector<std::size_t>& order) const {
    TestRows r{{}, {}, {}, {}, p, given};
    for (const std::size_t k : order) {
      r.position.push_back(position[k]);
      r.velocity.push_back(velocity[k]);
      r.density.push_back(density[k]);
      r.length.push_back(length[k]);
    }
    return r;
  }
};

/// n particles over a pool at rest; speeds and densities over `decades` powers of ten.
template <class Real>
TestRows<Real> random_rows(int n, double decades) {
  std::mt19937 gen(5);
  const auto r = [&] { return double(gen()) / 4294967295.0; };
  TestRows<Real> rows;
  rows.p.boundary.extent = {20, 10, 8};
  rows.given.rest = {2, 0, 1, 4, 0.5};
  for (int i = 0; i < n; ++i) {
    const double scale = std::pow(10, decades * (r() - 0.5));
    rows.position.push_back({Real(-1 + 22 * r()), Real(10 * r()), Real(8 * r()), Real(1)});
    rows.velocity.push_back(
        {Real(scale * (r() - 0.5)), Real(scale * (r() - 0.4)), Real(scale * (r() - 2)), Real(0)});
    rows.density.push_back(Real(0.8 + 0.4 * r() * scale));
    rows.length.push_back(int(60 * r()));
  }
  return rows;
}

/// All members are 8 bytes long: no padding.
bool same_bits(const MeasureSums& a, const MeasureSums& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Real, class Term>
double brute_force(const TestRows<Real>& rows, const Term& term) {
  long double sum = 0;
  for (std::size_t i = 0; i < rows.density.size(); ++i) sum += term(i);
  return double(sum);
}

}  // namespace

TEMPLATE_TEST_CASE("a measure has the same bits for any order of particles and number of threads",
                   "", float, double) {
  const int n = GENERATE(1, 2, 999, 30011);
  TestRows<TestType> rows = random_rows<TestType>(n, GENERATE(0.0, 12.0));
  if (n > 500) {
    rows.position[13].y = std::numeric_limits<TestType>::quiet_NaN();
    rows.density[480] = std::numeric_limits<TestType>::infinity();
    rows.position[7].x = -TestType(0), rows.position[9].x = TestType(0);
  }
  const MeasureSums once = rows.measure(1);
  CHECK(once.non_finite == (n > 500 ? 2 : 0));
  std::vector<std::size_t> order(rows.density.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::mt19937 gen(11);
  for (const int threads : {1, 2, 3, 7}) {
    CHECK(same_bits(rows.measure(threads), once));
    std::shuffle(order.begin(), order.end(), gen);
    CHECK(same_bits(rows.in_order(order).measure(threads), once));
  }
  std::reverse(order.begin(), order.end());
  CHECK(same_bits(rows.in_order(order).measure(2), once));
}

TEMPLATE_TEST_CASE("the sums of a measure are those of long double to 1e-13", "", float, double) {
  const int n = GENERATE(1, 500, 20000);
  const TestRows<TestType> rows = random_rows<TestType>(n, GENERATE(0.0, 6.0));
  const MeasureSums s = rows.measure(2);
  const auto close = [](double a, double b, double terms) {
    CAPTURE(a, b, terms);
    CHECK(std::fabs(a - b) <= 1e-13 * terms);
  };
  const auto all = [&](const auto& term, double got) {
    // Relative to the sum where the terms have one sign, else to the sum of their sizes.
    close(got, brute_force(rows, term),
          brute_force(rows, [&](std::size_t i) { return std::fabs(term(i)); }));
  };
  using L = long double;
  const auto c = [&](std::size_t i) { return std::max(L(double(rows.density[i]) - 1), L(0)); };
  all(c, s.compression);
  all([&](std::size_t i) { return c(i) * c(i); }, s.compression_squared);
  all(
      [&](std::size_t i) {
        const auto& v = rows.velocity[i];
        return L(v.x) * L(v.x) + L(v.y) * L(v.y) + L(v.z) * L(v.z);
      },
      s.speed_squared);
  for (int k = 0; k < 3; ++k) {
    all([&](std::size_t i) { return L((&rows.position[i].x)[k]); }, s.x[k]);
    all([&](std::size_t i) { return L((&rows.velocity[i].x)[k]); }, s.v[k]);
  }
  for (int k = 0; k < MeasureSums::levels; ++k)
    all(
        [&](std::size_t i) {
          const L level = L(4) * (k + 1) / 8, z = rows.position[i].z;
          return std::min(std::max((level - z) / L(0.5) + L(0.5), L(0)), L(1));
        },
        s.below[k]);
}

TEST_CASE("momenta that cancel leave nothing, however many they are") {
  TestRows<double> rows = random_rows<double>(20000, 6);
  for (std::size_t i = 0; i < 10000; ++i) {
    const auto& v = rows.velocity[i];
    rows.velocity[19999 - i] = {-v.x, -v.y, -v.z, 0};
  }
  const MeasureSums s = rows.measure(2);
  for (const double v : s.v) CHECK(v == 0);
}

TEST_CASE("terms of any size neither overflow nor vanish") {
  using Limits = std::numeric_limits<double>;
  const double size = GENERATE(0.0, Limits::denorm_min(), 1e-300, 1e-160, 1e-3, 1.0, 1e100, 1e150);
  TestRows<double> rows = random_rows<double>(3000, 0);
  for (std::size_t i = 0; i < 3000; ++i) {
    rows.velocity[i] = {size, -size, size / 2, 0};
    rows.position[i] = {size, -size, size / 2, 1};
    rows.density[i] = 1 + size;
  }
  const MeasureSums s = rows.measure(2);
  CAPTURE(size);
  CHECK(s.non_finite == 0);
  // Units are at least 2^-1000 (1e-301): what is 2^-62 of that is cut off.
  const double smallest = 3000 * 0x1p-1060;
  CHECK(s.v[0] == Approx(3000 * size).epsilon(1e-14).margin(smallest));
  CHECK(s.v[1] == -s.v[0]);
  CHECK(s.x[2] == Approx(1500 * size).epsilon(1e-14).margin(smallest));
  CHECK(s.speed_squared == Approx(3000 * 2.25 * size * size).epsilon(1e-14).margin(smallest));
  CHECK(s.compression == Approx(3000 * (1 + size - 1)).epsilon(1e-14).margin(smallest));
  const double c = 1 + size - 1;
  CHECK(s.compression_squared == Approx(3000 * c * c).epsilon(1e-14).margin(smallest));
}

TEST_CASE("2^31 of the largest terms fit, and the smallest unit still counts") {
  const double sign = GENERATE(1.0, -1.0);
  FixedSum all = fixed_term(sign);
  for (int k = 0; k < 31; ++k) {
    const FixedSum same = all;
    all.add(same);
  }
  CHECK(value_of(all, 0) == sign * 0x1p31);
  all.add(fixed_term(-sign));
  CHECK(value_of(all, 0) == sign * (0x1p31 - 1));
  CHECK(value_of(fixed_term(sign * 0x1p-62), 62) == sign);
  CHECK(value_of(fixed_term(sign * 0x1p-63), 62) == 0);
  CHECK(value_of(fixed_term(sign * 1e300), 3) == sign * 8);
}
