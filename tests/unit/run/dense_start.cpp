// Which starts are examined for dense fluid: those with bodies that overlap, found pair by pair
// here.
#include <random>

#include "lib/run/start_neighbors.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

TEST_CASE("a start of blocks is sampled exactly when two of them overlap, however they lie") {
  std::mt19937 gen(7);
  const auto grid = [&gen](int cells) { return 0.1 * double(gen() % unsigned(cells)); };
  int dense = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    Scene s = parse(kMinimal);
    s.domain.max = {100, 100, 100};
    s.bodies.assign(1 + gen() % 12, s.bodies[0]);
    // Corners on a coarse grid: many touch, which is no overlap. Now and then flat in one axis.
    const int reach[] = {repeat % 3 == 0 ? 4 : 40, repeat % 3 == 1 ? 4 : 40, 40};
    for (Body& b : s.bodies)
      for (std::size_t k = 0; k < 3; ++k) {
        b.min[k] = grid(reach[k]);
        b.max[k] = b.min[k] + 0.1 + grid(10);
      }
    bool expected = false;
    for (std::size_t i = 0; i < s.bodies.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        bool apart = false;
        for (std::size_t k = 0; k < 3; ++k)
          apart = apart || s.bodies[i].max[k] <= s.bodies[j].min[k] + 1e-9 ||
                  s.bodies[j].max[k] <= s.bodies[i].min[k] + 1e-9;
        expected = expected || !apart;
      }
    CAPTURE(repeat);
    REQUIRE(start_neighbors({s, ""}, 1000).count.empty() == !expected);
    dense += expected;
  }
  CHECK(dense > 100);
  CHECK(dense < 350);
}

}  // namespace pbf::scene_test
