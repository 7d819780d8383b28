// Which axis of the box becomes which axis of the internal frame.
#include "lib/program/axes.h"

#include <nlohmann/json.hpp>

#include "lib/program/plan.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

Scene box(double x, double y, double z, Double3 gravity = {0, 0, -9.81}, int dimensions = 3) {
  Scene s;
  s.domain.min = {-1, 0.3, 7};
  s.domain.max = {-1 + x, 0.3 + y, 7 + z};
  s.gravity = gravity;
  s.dimensions = dimensions;
  return s;
}
std::string axes(const Scene& s) { return axes_text(internal_axes(s)); }

}  // namespace

TEST_CASE(
    "internal z is the longest edge of the box, and internal x the longer one of the others") {
  CHECK(axes(box(1, 2, 3)) == "y, x, z");
  CHECK(axes(box(2, 1, 3)) == "x, y, z");
  CHECK(axes(box(3, 2, 1)) == "y, z, x");
  CHECK(axes(box(3, 1, 2)) == "z, y, x");
  CHECK(axes(box(1, 3, 2)) == "z, x, y");
  CHECK(axes(box(2, 3, 1)) == "x, z, y");
}

TEST_CASE("of edges alike internal z is not gravity's, and not for a rounding's sake") {
  CHECK(axes(box(1, 1, 1)) == "x, z, y");
  CHECK(axes(box(1, 1, 1, {0, -9.81, 0})) == "x, y, z");
  CHECK(axes(box(1, 1, 1, {0, 0, 0})) == "x, y, z");
  CHECK(axes(box(1, 1, 1, {0, -2, -9})) == "y, z, x");
  CHECK(axes(box(2, 1, 2)) == "z, y, x");
  CHECK(axes(box(1, 2, 2, {0, -9, 0})) == "y, x, z");
  CHECK(axes(box(0.1 + 0.2, 0.3, 0.3)) == axes(box(0.3, 0.3, 0.3)));
  CHECK(axes(box(1, 1, 1 + 1e-12)) == axes(box(1, 1, 1)));
  CHECK(axes(box(1, 1, 1.001)) == "x, y, z");
}

TEST_CASE("in two dimensions y stays the thickness, however thick") {
  CHECK(axes(box(2, 0.02, 1, {0, 0, -9.81}, 2)) == "z, y, x");
  CHECK(axes(box(1, 0.02, 2, {0, 0, -9.81}, 2)) == "x, y, z");
  CHECK(axes(box(1, 0.02, 1, {0, 0, -9.81}, 2)) == "z, y, x");
  CHECK(axes(box(1, 0.02, 1, {-9.81, 0, 0}, 2)) == "x, y, z");
  CHECK(axes(box(1, 5, 2, {0, 0, -9.81}, 2)) == "x, y, z");
}

TEST_CASE("a scene in internal axes has its box, faces and gravity turned, and no more") {
  Scene s = box(3, 2, 1, {1, 2, 3});
  s.domain.open = {"x_min", "y_max", "z_min"};
  const Axes a = internal_axes(s);  // y, z, x
  const Scene t = in_internal_axes(s, a);
  CHECK(t.domain.min == Double3{0.3, 7, -1});
  CHECK(t.domain.max == Double3{2.3, 8, 2});
  CHECK(t.gravity == Double3{2, 3, 1});
  CHECK(t.domain.open == std::vector<std::string>{"z_min", "x_max", "y_min"});
  for (int k = 0; k < 3; ++k) CHECK(a.inside(a.of[k]) == k);
  CHECK(a.handedness() == 1);
  CHECK(internal_axes(box(1, 2, 3)).handedness() == -1);
  CHECK(internal_axes(box(2, 1, 3)).handedness() == 1);
}

TEST_CASE("the plan holds the axes, says them, and numbers its cells along them") {
  Scene s = box(3, 2, 1);
  s.domain.min = {0, 0, 0};
  s.domain.max = {3, 2, 1};
  s.fluid.spacing = 0.05;
  const Plan p = make_plan(s, 100000);
  CHECK(p.axes == internal_axes(s));
  CHECK(p.cells[0] == 41);  // half cells of 0.05 m along 2 m
  CHECK(p.cells[1] == 11);
  CHECK(p.cells[2] == 31);
  CHECK(plan_text(p, s).find("internal axes x, y, z: y, z, x of the scene") != std::string::npos);
  CHECK(json_text(plan_json(p, s)).find("\"axes\":[\"y\",\"z\",\"x\"]") != std::string::npos);
}
