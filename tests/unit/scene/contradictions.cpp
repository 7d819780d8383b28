// Values that are fine alone and wrong together.
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

TEST_CASE("scene: values that contradict each other are refused") {
  const auto error = [](const std::vector<std::string>& set) { return parse_error(kMinimal, set); };
  CHECK(contains(error({"domain.max=[1, 0, 1]"}), "domain.max: y is 0, not above domain.min (0)"));
  CHECK(contains(error({"time.end=0.001"}), "time.end: is 0.001, below time.step (0.01 s)"));
  CHECK(contains(error({"time.step=1e-12", "time.end=1e9"}), "updates, at most 2147483647"));
  CHECK(contains(error({"fluid.spacing=-0.1"}), "\"-0.1\" is out of range"));
  CHECK(contains(error({"fluid.spacing=0.0001"}), "the scene would have 5e+11 particles"));
  CHECK(contains(error({"fluid.spacing=0.6"}), "bodies[0]: makes no particle"));
  CHECK(
      contains(error({"time.order=2", "solver.kernels=paper"}),
               "time.order: the paper's method (solver.kernels: paper) is of first order; give 1, "
               "or solver.kernels: consistent"));
  CHECK(error({"time.order=2"}) == "no error");
  CHECK(error({"time.order=1", "solver.kernels=paper"}) == "no error");
  CHECK(contains(error({"fluid.smoothing_ratio=0.5"}), "out of range, allowed: 1 .. 10"));
}

TEST_CASE(
    "scene: a smoothing ratio at which a pool loses volume is refused, but for a given mass") {
  const auto with = [](int dimensions, const std::string& fluid) {
    return parse_error("dimensions: " + std::to_string(dimensions) +
                       "\ndomain: {min: [0, 0, 0], max: [1, 0.1, 1]}\nfluid: {spacing: 0.1, " +
                       fluid + "}\nbodies: [{shape: block, min: [0, 0, 0], max: [1, 0.1, 0.5]}]\n" +
                       "time: {step: 0.01, end: 1}\n");
  };
  const std::string few = with(3, "smoothing_ratio: 1.2");
  CHECK(few.rfind("2 ", 0) == 0);
  CHECK(contains(few, "scene.yaml:3:40: fluid.smoothing_ratio: is 1.2"));
  CHECK(contains(few, "give at least 1.6 (1.5 with dimensions: 2), 2 is the default"));
  CHECK(contains(with(3, "smoothing_ratio: 1"), "fluid.smoothing_ratio: is 1:"));
  CHECK(contains(with(3, "smoothing_ratio: 1.59"), "give at least 1.6"));
  CHECK(contains(with(2, "smoothing_ratio: 1.49"), "give at least 1.5, 2 is the default"));
  CHECK(with(3, "smoothing_ratio: 1.6") == "no error");
  CHECK(with(2, "smoothing_ratio: 1.5") == "no error");
  CHECK(with(3, "smoothing_ratio: 1.2, mass: 0.8") == "no error");
}

TEST_CASE("scene: a spacing larger than the domain is fine when a particle results") {
  const Scene s = parse(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 3}\n"
      "bodies: [{shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.1}]\n"
      "time: {step: 0.01, end: 1}\n");
  CHECK(s.h() == 6);
}

TEST_CASE("in two dimensions, what has no place in a plane is refused with the remedy") {
  const auto error = [](std::vector<std::string> with) {
    with.insert(with.begin(), {"dimensions=2", "domain.max=[1, 0.1, 1]"});
    return parse_error(kMinimal, with);
  };
  CHECK(error({}) == "no error");
  CHECK(error({"domain.max=[1, 0.2, 1]"}) == "no error");  // h
  CHECK(
      contains(error({"domain.max=[1, 0.21, 1]"}),
               "domain.max: y makes a slab 0.21 m thick, with dimensions: 2 it may be at most the "
               "smoothing length 0.2 m (one cell); give y = 0.1 for one spacing"));
  CHECK(contains(error({"domain.max=[1, 0, 1]"}), "domain.max: y is 0, not above domain.min (0)"));
  CHECK(contains(error({"domain.open=[x_min, y_max]"}),
                 "domain.open: y_max: with dimensions: 2 there is no wall along y; remove it"));
  CHECK(contains(error({"gravity=[0, -9.81, 0]"}),
                 "gravity: its y component is -9.81, with dimensions: 2 nothing moves along y"));
  CHECK(contains(error({"bodies[0].velocity=[1, 2, 0]"}),
                 "bodies[0].velocity: its y component is 2, with dimensions: 2 nothing moves"));
  CHECK(contains(error({"bodies[0].min=[0, 0.06, 0]"}),
                 "bodies[0]: its y goes from 0.06 to 1, which leaves out the plane of the "
                 "particles, y = 0.05"));
  CHECK(contains(error({"dimensions=1"}), "dimensions"));
  CHECK(contains(error({"dimensions=4"}), "dimensions"));
  // The slab is no narrow place for particles: they keep to its middle.
  CHECK(error({"solver.wall_margin=0.08"}) == "no error");
}

}  // namespace pbf::scene_test
