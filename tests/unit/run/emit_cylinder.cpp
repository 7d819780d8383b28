// Bodies that are cylinders: discs of the lattice along the axis.
#include <algorithm>
#include <cmath>

#include "lib/run/emit.h"
#include "lib/run/start_neighbors.h"
#include "lib/run/warnings.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/body_box.h"
#include "lib/scene/vector3.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

Scene with_cylinder(Double3 from, Double3 to, double radius, double spacing = 0.1) {
  Scene s;
  s.fluid.spacing = spacing;
  s.bodies.resize(1);
  s.bodies[0].shape = Shape::cylinder;
  s.bodies[0].from = from;
  s.bodies[0].to = to;
  s.bodies[0].radius = radius;
  return s;
}

const std::string kTank =
    "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\ntime: {step: 0.01, end: 1}\n";

std::string body_error(const std::string& keys, const std::string& more = "") {
  return parse_error(kTank + more + "bodies: [{shape: cylinder, " + keys + "}]\n");
}

}  // namespace

TEST_CASE("cylinder: upright, its discs stand like the layers of a block") {
  const Scene s = with_cylinder({0.5, 0.5, 0}, {0.5, 0.5, 0.4}, 0.1);
  const Particles p = emit_particles(s, "");
  REQUIRE(p.size() == 4 * 5);
  CHECK(count_particles(s, "") == 20);
  CHECK(p.position[0][2] == 0.05);
  CHECK(p.position[19][2] == 3.5 * 0.1);
  for (const Double3& x : p.position) {
    const double i = (x[0] - 0.5) / 0.1, j = (x[1] - 0.5) / 0.1;
    CHECK(std::fabs(i - std::round(i)) < 1e-9);
    CHECK(i * i + j * j < 1 + 1e-6);
  }
}

TEST_CASE("cylinder: every particle is inside, as many as its volume has room for") {
  const Double3 from{0.2, 0.3, 0.15}, to{0.7, 0.6, 0.85};
  const Scene s = with_cylinder(from, to, 0.2, 0.02);
  const Particles p = emit_particles(s, "");
  const Double3 axis = unit(to - from);
  const BodyBox box = body_box(s.bodies[0]);
  for (const Double3& x : p.position) {
    const double along = dot(x - from, axis);
    CHECK((along > 0 && along < length(to - from)));
    CHECK(length(x - from - along * axis) <= 0.2 * (1 + 1e-6));
    for (std::size_t a = 0; a < 3; ++a) CHECK((x[a] >= box.low[a] && x[a] <= box.high[a]));
  }
  const double volume = 3.14159265 * 0.2 * 0.2 * length(to - from) / (0.02 * 0.02 * 0.02);
  CHECK(std::fabs(double(p.size()) / volume - 1) < 0.05);
  // The nearest neighbors are a spacing apart.
  double least = 1;
  for (std::size_t i = 1; i < p.size(); ++i)
    least = std::min(least, length(p.position[i] - p.position[0]));
  CHECK(std::fabs(least - 0.02) < 1e-9);
}

TEST_CASE("cylinder: in two dimensions a disc") {
  Scene s = with_cylinder({0.5, 0, 0.5}, {0.5, 0.1, 0.5}, 0.2);
  s.dimensions = 2;
  s.domain.max[1] = 0.1;
  const Particles p = emit_particles(s, "");
  CHECK(p.size() == 13);
  CHECK(count_particles(s, "") == 13);
  for (const Double3& x : p.position) CHECK(x[1] == 0.05);
}

TEST_CASE("cylinder: overlaps are seen, touching is none") {
  Scene s = with_cylinder({0.5, 0.5, 0.4}, {0.5, 0.5, 0.8}, 0.2, 0.05);
  s.bodies.resize(2);
  s.bodies[1].max = {1, 1, 0.4};
  CHECK(find_overlap({s, "."}).inside == 0);
  s.bodies[1].max = {1, 1, 0.5};
  const Overlap o = find_overlap({s, "."});
  CHECK(o.inside > 0);
  s.bodies[1] = Body{};
  s.bodies[1].min = {0.75, 0, 0};  // beside it, within its box along x and y only
  s.bodies[1].max = {1, 1, 1};
  CHECK(find_overlap({s, "."}).inside == 0);
}

TEST_CASE("cylinder: what is wrong with one") {
  CHECK(body_error("from: [0.5, 0.5, 0], to: [0.5, 0.5, 1], radius: 0.2") == "no error");
  struct Case {
    std::string keys, message;
  };
  const std::vector<Case> cases{
      {"from: [0.5, 0.5, 0], to: [0.5, 0.5, 1]", "bodies[0].radius: missing; required, in m"},
      {"from: [0.5, 0.5, 0], radius: 0.2", "bodies[0].to: missing"},
      {"from: [0.5, 0.5, 0], to: [0.5, 0.5, 0], radius: 0.2",
       "bodies[0].to: is where the axis begins (bodies[0].from); give the other end"},
      {"from: [0.5, 0.5, 0], to: [0.5, 0.5, 1.2], radius: 0.2", "bodies[0]: reaches z = 1.2"},
      {"from: [0.1, 0.5, 0], to: [0.1, 0.5, 1], radius: 0.2", "bodies[0]: reaches x = -0.1"},
      {"from: [0.5, 0.5, 0], to: [0.5, 0.5, 0.05], radius: 0.2", "bodies[0]: makes no particle"},
      {"from: [0.5, 0.5, 0], to: [0.5, 0.5, 1], radius: 0", "bodies[0].radius: \"0\" is out of"},
      {"from: [0.5, 0.5, 0], to: [0.5, 0.5, 1], radius: 0.2, center: [0, 0, 0]",
       "bodies[0].center: belongs to shape sphere, this body is a cylinder"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.keys, body_error(c.keys));
    CHECK(contains(body_error(c.keys), c.message));
  }
  const Scene many = with_cylinder({0, 0, 0}, {0, 0, 1e6}, 1e6, 1e-3);
  CHECK(contains(error_of([&] { count_particles(many, ""); }), "at most 2147483647"));
}

TEST_CASE("warnings: a step far above the rule of auto, where nothing lies deep") {
  const auto step_warning = [](const Scene& s) {
    for (const Warning& w : scene_warnings({s, ""}, 100))
      if (w.kind == "step") return w.text;
    return std::string();
  };
  Scene s = with_cylinder({0.5, 0.5, 0.4}, {0.5, 0.5, 0.5}, 0.1, 0.05);
  const double safe = step_rule(s).gravity;
  s.time.step = 9 * safe;
  CHECK(step_warning(s) == "");
  s.time.step = 12 * safe;
  CHECK(contains(step_warning(s), "times 0.03 sqrt(h/g)"));
  CHECK(contains(step_warning(s), "or less, or auto"));
  s.solver.substeps = 2;
  CHECK(step_warning(s) == "");
  s.solver.substeps = 1;
  s.gravity = {};
  CHECK(step_warning(s) == "");
}

}  // namespace pbf::scene_test
