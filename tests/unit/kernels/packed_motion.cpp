// Packed rows against the numbers that they stand for, and XSPH of packed rows against the same sum
// in double from the rows themselves.
#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/boundary/far_boundary.h"
#include "kernels/pass_packed_xsph.h"
#include "tests/support/catch.h"
#include "tests/support/random_vectors.h"

namespace {

using namespace pbf;
using test::RandomVectors;

/// x (h), dt v (h), 1/density.
struct Mover {
  Vec3<float> x, way;
  float inverse_density;
};
/// Lists in which all are neighbors of each other.
struct All {
  std::vector<Mover> of{};
  void for_each(int i, const auto& f) const {
    for (int j = 0; j < int(of.size()); ++j)
      if (j != i) f(Neighbor{j});
  }
};
Vec4<float> packed(const Mover& m) { return packed_motion(m.x, m.way, m.inverse_density); }
double farthest(Vec3<float> found, Vec3<float> a, Vec3<float> b) {
  return std::max({std::fabs(found.x - (double(a.x) - b.x)),
                   std::fabs(found.y - (double(a.y) - b.y)),
                   std::fabs(found.z - (double(a.z) - b.z))});
}

TEST_CASE("packed motion: differences of neighbors are right to the steps of their rows") {
  const double place = GENERATE(0.0, -7.0, 3.9, 250.0, 3000.0);
  CAPTURE(place);
  RandomVectors random;
  double x = 0, way = 0, density = 0;
  for (int k = 0; k < 20000; ++k) {
    Mover a{random.vector(place, place + 4), random.vector(-0.9, 0.9), float(random(0.05, 8))};
    Mover b{a.x + random.vector(-1.9, 1.9), random.vector(-0.9, 0.9), float(random(0.05, 8))};
    const Vec4<float> p = packed(a), q = packed(b);
    x = std::max(x, farthest(packed_distance(p, q), a.x, b.x));
    way = std::max(way, farthest(kRingStep * packed_way_steps(p, q), a.way, b.way));
    density = std::max(density, std::fabs(packed_inverse_densities(p, q) -
                                          (double(a.inverse_density) + b.inverse_density)));
    // Opposite to the last bit, so that what one particle of a pair gets, the other one loses.
    const Vec3<float> d = packed_distance(q, p), w = packed_way_steps(q, p);
    REQUIRE(dot(d + packed_distance(p, q), d + packed_distance(p, q)) == 0);
    REQUIRE(dot(w + packed_way_steps(p, q), w + packed_way_steps(p, q)) == 0);
    REQUIRE(packed_inverse_densities(q, p) == packed_inverse_densities(p, q));
  }
  CHECK(x < 6.2e-5);
  CHECK(way < 2.1e-6);
  CHECK(density < 1.01 / 8192);
}

TEST_CASE("packed motion: equal velocities have no difference, wherever the particles are") {
  RandomVectors random;
  const Vec3<float> way = random.vector(-1, 1);
  for (int k = 0; k < 1000; ++k) {
    const Vec4<float> a = packed({random.vector(0, 50), way, float(random(0.3, 3))}),
                      b = packed({random.vector(0, 50), way, float(random(0.3, 3))});
    const Vec3<float> d = kRingStep * packed_way_steps(a, b);
    REQUIRE(std::sqrt(dot(d, d)) < 4e-6);
  }
}

TEST_CASE("packed motion: the row that pads lists adds nothing, and 1/density has limits") {
  const Vec4<float> a = packed({{1, 2, 3}, {0.1f, 0.2f, 0.3f}, 1});
  CHECK(packed_inverse_densities(a, {1e9f, 1e9f, 1e9f, 1}) == 0);  // of positions
  CHECK(packed_inverse_densities(a, {0, 0, 0, 0}) == 0);           // of velocities
  const auto of = [&](float d) { return packed_inverse_densities(a, packed({{}, {}, d})) - 1; };
  CHECK(of(0) == 1.f / 8192);  // never that of the padding
  CHECK(of(1e-9f) == 1.f / 8192);
  CHECK(of(1e9f) == 16 - 1.f / 8192);
  CHECK(of(2) == 2);
}

TEST_CASE(
    "packed motion: XSPH differs from that of the rows by 1e-4 of itself and 1e-6 h in a step") {
  RandomVectors random;
  All all;
  for (int k = 0; k < 40; ++k)
    all.of.push_back({random.vector(57, 58.2), random.vector(0.1, 0.2), float(random(0.9, 1.1))});
  const float dt = 1e-3f;
  std::vector<Vec4<float>> position, velocity, motion, out(all.of.size());
  for (const Mover& m : all.of) {
    position.push_back(with_w(m.x, m.inverse_density));
    velocity.push_back(with_w((1 / dt) * m.way, 0.f));
    motion.push_back({});
  }
  const OwnRows<const Vec4<float>> x(position.data()), v(velocity.data());
  const PackMotionPass pack{dt, x, v, OwnRows<Vec4<float>>(motion.data())};
  for (int i = 0; i < int(motion.size()); ++i) pack(i);
  using Pass = PackedXsphPass<const All&, Smoothing::consistent, FirstOrder, Box<float>>;
  Params<float> p;
  p.dt = dt, p.inv_dt = 1 / dt, p.xsph = 0.5f, p.vol = 1.f / 40;
  const Pass pass{{p,
                   {},
                   all,
                   GatheredRows<Vec4<float>>(position.data()),
                   GatheredRows<Vec4<float>>(velocity.data()),
                   OwnRows<Vec4<float>>(out.data()),
                   nullptr,
                   {},
                   {}},
                  GatheredRows<Vec4<float>>(motion.data())};
  double momentum = 0, effect = 0, error = 0;
  for (int i = 0; i < int(motion.size()); ++i) {
    sum_over_neighbors(pass, i);
    double sum = 0;
    for (int j = 0; j < int(motion.size()); ++j) {
      const Vec4<float>&a = position[std::size_t(i)], &b = position[std::size_t(j)];
      const double q = std::hypot(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
      const double t = std::max(1 - q, 0.0);
      sum += t * t * t * (double(a.w) + b.w) *
             (double(velocity[std::size_t(j)].x) - velocity[std::size_t(i)].x);
    }
    sum *= 0.5 * 0.5 / 40 * 15 / 3.14159265358979;
    const double found = double(out[std::size_t(i)].x) - velocity[std::size_t(i)].x;
    momentum += found;
    effect = std::max(effect, std::fabs(sum));
    error = std::max(error, std::fabs(found - sum));
  }
  CAPTURE(effect, error, momentum);
  CHECK(effect > 5);  // h/s, of velocities from 100 to 200
  CHECK(error < 1e-4 * effect + 1e-6 / double(dt));
  CHECK(std::fabs(momentum) < 40 * 200 * 1.2e-7);
}

}  // namespace
