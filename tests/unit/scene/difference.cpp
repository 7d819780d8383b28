// What --resume takes: keys whose change leaves the results of a run alone up to its end.
#include "lib/scene/difference.h"
#include "lib/scene/keys.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

TEST_CASE("scene difference: exactly these keys leave the results of a run alone") {
  std::vector<std::string> none, adaptive;
  for (const Key& key : scene_table().keys) {
    if (key.path.starts_with("compare[].")) {  // all of them: they read results
      CHECK(key.effect == Effect::none);
      continue;
    }
    if (key.effect == Effect::none) none.push_back(key.path);
    if (key.effect == Effect::adaptive) adaptive.push_back(key.path);
  }
  CHECK(none == std::vector<std::string>{"name", "time.end", "solver.reproducible", "summary_from",
                                         "summary", "checkpoint.every", "backend", "threads"});
  CHECK(adaptive == std::vector<std::string>{"guard.speed", "guard.energy", "guard.neighbors"});
}

TEST_CASE("scene difference: every key that matters is named, with both values") {
  const auto difference = [](const std::vector<std::string>& now,
                             const std::vector<std::string>& before = {}) {
    return physics_difference(parse(kMinimal, before), parse(kMinimal, now));
  };
  CHECK(difference({}).empty());
  CHECK(difference({"solver.iterations=8"}) == "solver.iterations: 4 before, 8 now");
  CHECK(difference({"viscosity=on"}) == "viscosity: off before, on now");
  CHECK(difference({"output={every: 0.5}"}, {"output=on"}) == "output.every: 0.02 before, 0.5 now");
  CHECK(difference({"bodies[0].velocity=[0, 0, 1]"}) ==
        "bodies[0].velocity: [0, 0, 0] before, [0, 0, 1] now");
  CHECK(difference({"bodies=[{shape: sphere, center: [.5, .5, .5], radius: .2}]"}) ==
        "bodies[0].shape: block before, sphere now");
  CHECK(difference({"bodies=[{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}, "
                    "{shape: sphere, center: [.5, .5, .8], radius: .2}]"}) ==
        "bodies: 1 before, 2 now");
  // Keys come before bodies, wherever the file has them.
  CHECK(
      difference({"bodies[0].velocity=[0, 0, 1]", "gravity=[0, 0, 0]"}) ==
      "gravity: [0, 0, -9.81] before, [0, 0, 0] now; bodies[0].velocity: [0, 0, 0] before, [0, 0, "
      "1] now");
  // A block that comes, or another kind, brings its keys: they are not listed too.
  CHECK(difference({"viscosity.xsph=0.3", "solver.iterations=8"}) ==
        "viscosity: off before, on now; solver.iterations: 4 before, 8 now");
  CHECK(difference({"tank_motion={kind: file, path: t.csv, axis: [0, 1, 0]}"},
                   {"tank_motion={kind: sine, axis: [0, 1, 0], amplitude: 2, period: 3}"}) ==
        "tank_motion.kind: sine before, file now");
}

TEST_CASE("scene difference: a long list is cut, and says how much more there is") {
  std::vector<std::string> parts{"a", "b"};
  CHECK(first_of({}) == "");
  CHECK(first_of(parts) == "a; b");
  CHECK(first_of(parts, 2) == "a; b");
  CHECK(first_of({"a", "b", "c", "d"}, 2) == "a; b; and 2 more");
  std::string many, others;
  for (int k = 0; k < 12; ++k) {
    many += ", {shape: sphere, center: [.5, .5, .5], radius: .2}";
    others += ", {shape: sphere, center: [.5, .5, .5], radius: .1}";
  }
  const std::string first = "bodies=[{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}";
  const std::string said = physics_difference(parse(kMinimal, {first + many + "]"}),
                                              parse(kMinimal, {first + others + "]"}));
  CHECK(contains(said, "bodies[1].radius: 0.2 before, 0.1 now; bodies[2].radius"));
  CHECK(contains(said, "bodies[8].radius: 0.2 before, 0.1 now; and 4 more"));
  CHECK_FALSE(contains(said, "bodies[9]"));
}

TEST_CASE("scene difference: the guard matters where its alarms shorten the step") {
  for (const bool adaptive : {false, true}) {
    const std::string scene =
        "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}]\n"
        "time: {step: 0.01, end: 1, adaptive: " +
        std::string(adaptive ? "on" : "off") + "}\n";
    CAPTURE(adaptive);
    const Scene plain = parse(scene), other = parse(scene, {"guard.speed=7"}),
                off = parse(scene, {"guard=off"});
    CHECK(physics_difference(plain, other) == (adaptive ? "guard.speed: auto before, 7 now" : ""));
    CHECK(physics_difference(plain, off) == (adaptive ? "guard: on before, off now" : ""));
    CHECK(physics_difference(plain, parse(scene, {"checkpoint=on", "threads=2", "time.end=2"}))
              .empty());
  }
}

}  // namespace pbf::scene_test
