// The plan of a scene with periodic axes: cells and rows for images.
#include "lib/program/axes.h"
#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::periodic_plan_test {

using namespace scene_test;

TEST_CASE("a periodic axis has one more cell of the grid on each side, and rows for images") {
  // 1 m is 5 h.
  const std::string still = "gravity=[0, 0, 0]";
  const Scene walls = parse(kMinimal, {still}),
              periodic = parse(kMinimal, {still, "domain.periodic=[x, z]"});
  const Plan a = make_plan(walls, 500), b = make_plan(periodic, 500);
  REQUIRE(b.axes == a.axes);
  for (int k = 0; k < 3; ++k) {
    const int axis = b.axes.of[k], more = axis == 1 ? 0 : k == 0 ? 4 : 2;  // x counts half cells
    CAPTURE(k, axis);
    CHECK(b.cells[k] == a.cells[k] + more);
  }
  CHECK(a.images == 0);
  CHECK(a.capacity == 500);
  CHECK(b.images == 3 * 500);  // no particle has more than three
  CHECK(b.capacity == 500 + b.images);
  CHECK(b.most_particles() == 500);
  // Else twice the 8 particles in h^3 of fluid at rest, in shells of 1.05 h on each side.
  const Plan large = make_plan(periodic, 100000);
  CHECK(large.images == std::int64_t(2 * 8 * (7.1 * 7.1 * 5 - 125) + 256));
}

TEST_CASE("a periodic scene in which particles come and go is refused by its key") {
  Scene s = parse(kMinimal, {"domain.periodic=[x]"});
  s.capacity = 1000;
  CHECK(contains(error_of([&] { make_plan(s, 500); }), "periodic axes (domain.periodic)"));
}

TEST_CASE("solver.levels: auto is off in a periodic scene, and the plan says why") {
  const Scene s = parse(kMinimal, {"domain.periodic=[x]", "solver.levels=auto"});
  REQUIRE(why_no_levels(s));
  CHECK(contains(why_no_levels(s), "periodic axes"));
}

TEST_CASE("periodic axes go with the internal axes") {
  Scene s = parse(kMinimal, {"domain.periodic=[x, y]"});
  const Scene t = in_internal_axes(s, Axes{{2, 0, 1}});
  CHECK(t.domain.is_periodic(1));
  CHECK(t.domain.is_periodic(2));
  CHECK_FALSE(t.domain.is_periodic(0));
}

}  // namespace pbf::periodic_plan_test
