#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/scene/random.h"
#include "lib/verify/statistics.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;

namespace {

std::vector<double> uniform(std::size_t n, std::uint64_t seed, double shift = 0) {
  SplitMix64 random(seed);
  std::vector<double> v(n);
  for (double& x : v) x = random.uniform() + shift;
  std::sort(v.begin(), v.end());
  return v;
}

/// The definition: the largest gap of the two distribution functions, at every point.
double slow_ks(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (const auto* points : {&a, &b})
    for (const double x : *points) {
      const auto share = [x](const std::vector<double>& v) {
        return double(std::count_if(v.begin(), v.end(), [x](double y) { return y <= x; })) /
               double(v.size());
      };
      worst = std::max(worst, std::fabs(share(a) - share(b)));
    }
  return worst;
}

const Statistic& number(const FrameStatistics& f, const std::string& name) {
  for (const auto& s : f.numbers)
    if (s.name == name) return s;
  throw std::runtime_error(name);
}

}  // namespace

TEST_CASE("the KS distance is that of its definition, with ties and unequal sizes", "[compare]") {
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    auto a = uniform(40, seed), b = uniform(17, seed + 100, 0.2);
    for (double& x : a) x = std::round(10 * x);
    for (double& x : b) x = std::round(10 * x);
    CHECK(ks_distance(a, b) == Approx(slow_ks(a, b)));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(ks_distance({1, 2}, {1, 2}) == 0);
  CHECK(ks_distance({1, 2}, {3, 4}) == 1);
  CHECK(ks_distance({1, nan}, {1, nan}) == 0);
  CHECK(ks_distance({1, 2}, {1, nan}) == 0.5);
}

TEST_CASE("values within the rounding are ties, and the KS distance is that of its definition",
          "[compare]") {
  // The smallest distance of moved samples: share of a up to x less that of b up to x + rounding.
  const auto slow = [](const std::vector<double>& a, const std::vector<double>& b,
                       double rounding) {
    double worst = 0;
    const auto share = [](const std::vector<double>& v, double x) {
      return double(std::count_if(v.begin(), v.end(), [x](double y) { return y <= x; })) /
             double(v.size());
    };
    for (const double x : a) worst = std::max(worst, share(a, x) - share(b, x + rounding));
    for (const double x : b) worst = std::max(worst, share(b, x) - share(a, x + rounding));
    return worst;
  };
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    auto a = uniform(40, seed), b = uniform(17, seed + 100, 0.2);
    for (auto* v : {&a, &b})
      for (double& x : *v) x = std::round(8 * x) / 8;
    for (const double rounding : {0.0, 0.125, 0.2, 5.0})
      CHECK(ks_distance(a, b, rounding) == Approx(slow(a, b, rounding)));
  }
  CHECK(ks_distance({1, 1, 1}, {1.01, 0.99, 1.01}) > 0.6);
  CHECK(ks_distance({1, 1, 1}, {1.01, 0.99, 1.01}, 0.02) == 0);
  CHECK(ks_distance({}, {1, 2}, 1) == 0);
}

TEST_CASE("samples of one distribution stay below the critical distance, others do not",
          "[compare]") {
  int above = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed)
    if (ks_distance(uniform(500, seed), uniform(300, seed + 1000)) > ks_critical(0.05, 500, 300))
      ++above;
  CHECK(above > 5);  // 20 expected
  CHECK(above < 40);
  CHECK(ks_distance(uniform(500, 1), uniform(300, 2, 0.25)) > ks_critical(1e-6, 500, 300));
}

TEST_CASE("an exponential gives its e-folding time, noise without growth none", "[compare]") {
  std::vector<double> x, y, flat;
  for (int k = 0; k < 50; ++k) {
    x.push_back(k);
    y.push_back(std::min(1e-7 * std::exp(k / 8.0), 1e-5));
    flat.push_back(1e-7);
  }
  CHECK(e_folding(x, y, 0.99e-5) == Approx(8));
  CHECK(e_folding(x, flat, 1) == 0);
  CHECK(e_folding({1, 2}, {1, 2}, 10) == 0);
  CHECK(e_folding(x, std::vector<double>(50, 0.0), 1) == 0);
}

TEST_CASE("the statistics of a frame are those of its particles", "[compare]") {
  const Snapshot s = test::sample(3, 2000, ScalarType::f64);
  const auto f = frame_statistics(s, {1, 0, 0}, {0, 0, -10}, 1000);
  const auto x = s.fields[0].as<double>(), v = s.find("velocity")->as<double>();
  double cx = 0, potential = 0, kinetic = 0;
  for (std::size_t i = 0; i < s.count; ++i) {
    cx += x[3 * i] - 1;
    potential += 10 * x[3 * i + 2];
    for (std::size_t k = 0; k < 3; ++k) kinetic += 0.5 * v[3 * i + k] * v[3 * i + k];
  }
  CHECK(number(f, "centre of mass x").value == Approx(cx / 2000));
  CHECK(number(f, "potential energy").value == Approx(potential / 2000));
  CHECK(number(f, "kinetic energy").value == Approx(kinetic / 2000));
  CHECK(number(f, "centre of mass x").uncertainty > 0);
  const auto front = number(f, "front x (99.9 %)");
  std::vector<double> sorted;
  for (std::size_t i = 0; i < s.count; ++i) sorted.push_back(x[3 * i] - 1);
  std::sort(sorted.begin(), sorted.end());
  CHECK(front.value == sorted[1997]);
}

TEST_CASE("statistics leave out what a frame does not hold", "[compare]") {
  Snapshot s = test::sample(1, 10);
  number(frame_statistics(s, {0, 0, 0}, {0, 0, -10}, 1000), "kinetic energy");  // is there
  std::erase_if(s.fields, [](const FieldArray& f) { return f.name != "position"; });
  const auto f = frame_statistics(s, {0, 0, 0}, {0, 0, -10}, 1000);
  CHECK(f.distributions.size() == 3);
  CHECK(f.numbers.size() > 0);
  for (const auto& n : f.numbers) CHECK(n.name != "kinetic energy");
  CHECK(frame_statistics(Snapshot{}, {}, {}, 1).numbers.empty());
}

TEST_CASE("particles that move as one count as one sample, independent ones as many", "[compare]") {
  // 40 x 10 x 1 cells of edge 1 with 25 particles each.
  SplitMix64 random(3);
  std::vector<double> x, own, shared, wave;
  for (int cell = 0; cell < 400; ++cell) {
    const double of_cell = random.uniform();
    for (int k = 0; k < 25; ++k) {
      for (const double corner : {double(cell % 40), double(cell / 40), 0.0})
        x.push_back(corner + 0.999 * random.uniform());
      own.push_back(random.uniform());
      shared.push_back(of_cell);
      wave.push_back(cell % 40 / 4 % 2);  // crests and troughs of 4 cells
    }
  }
  const auto sorted = [](std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v;
  };
  const Clusters cells(x, 1), alone(x, 0);
  // From the finest grid 25; coarser ones scatter about that.
  for (const double effect :
       {cells.design_effect(shared), cells.design_effect_of_shares(shared, sorted(shared))}) {
    CHECK(effect >= Approx(25));
    CHECK(effect < 50);
  }
  CHECK(cells.design_effect(wave) >= Approx(4 * 2 * 25));
  CHECK(cells.mean_size() == Approx(25));
  CHECK(alone.mean_size() == 1);
  CHECK(cells.design_effect(own) < 1.5);
  CHECK(cells.design_effect_of_shares(own, sorted(own)) < 1.5);
  CHECK(alone.design_effect(shared) == 1);
  CHECK(cells.design_effect(std::vector<double>(x.size() / 3, 2.0)) == 1);
  shared[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK(cells.design_effect(shared) == 1);
  x[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(Clusters(x, 1).design_effect(own) < 1.5);
}
