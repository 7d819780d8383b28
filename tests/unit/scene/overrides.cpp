// --set: the same keys and checks as the file, with its own place.
#include "lib/base/plain_text.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

TEST_CASE("option --set: replaces and creates values, the last one wins") {
  const Scene s = parse(kMinimal + "solver: {iterations: 2}\n",
                        {"solver.iterations=8", "solver.iterations=9", "gravity=[0, -9.8, 0]",
                         "name=x", "fluid.mass=0.5", "threads=3"});
  CHECK(s.solver.iterations == 9);
  CHECK(s.gravity == Double3{0, -9.8, 0});
  CHECK(s.name == "x");
  CHECK(s.fluid.mass == 0.5);
  CHECK(s.threads == 3);
}

TEST_CASE("option --set: bodies are named by index, in two spellings") {
  const std::string text = with_bodies(
      "[{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}, "
      "{shape: random_box, min: [0, 0, 0.5], max: [1, 1, 1], count: 5}]");
  CHECK(parse(text, {"bodies.1.count=131072"}).bodies[1].count == 131072);
  CHECK(parse(text, {"bodies[1].count=1e5"}).bodies[1].count == 100000);
  CHECK(parse(text, {"bodies[0].velocity=[1, 2, 3]"}).bodies[0].velocity == Double3{1, 2, 3});
  CHECK(parse(text, {"bodies=[{shape: sphere, center: [.5, .5, .5], radius: .2}]"}).bodies.size() ==
        1);
}

TEST_CASE("option --set: makes and removes optional blocks") {
  CHECK_FALSE(parse(kMinimal).viscosity);
  CHECK(parse(kMinimal, {"viscosity.xsph=0.2"}).viscosity->xsph == 0.2);
  CHECK(parse(kMinimal, {"render.camera.fov=50"}).render->camera.fov == 50);
  CHECK(parse(kMinimal, {"output={}"}).output == Output{});
  CHECK(parse(kMinimal + "viscosity: off\n", {"viscosity.xsph=0.2"}).viscosity->xsph == 0.2);
  for (const char* off : {"viscosity=off", "viscosity=null", "viscosity=~", "viscosity=false"})
    CHECK_FALSE(parse(kMinimal + "viscosity: {xsph: 0.1}\n", {off}).viscosity);
}

TEST_CASE("option --set: may supply what the file lacks") {
  const Scene expected = parse(kMinimal + "name: x\n");
  CHECK(parse("name: x\n",
              {"domain={min: [0, 0, 0], max: [1, 1, 1]}", "fluid.spacing=0.1", "time.step=0.01",
               "time.end=1", "bodies=[{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}]"}) ==
        expected);
}

TEST_CASE("option --set: what is wrong is reported with the argument as its place") {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"solver.iterations=x",
       "2 --set solver.iterations=x: solver.iterations: expected a whole number, got \"x\""},
      {"solver.iteratons=4", "solver.iteratons: unknown key, did you mean solver.iterations?"},
      {"foo.bar=1", "foo: unknown key"},
      {"solver.iterations", "expected key.path=value"},
      {"=4", "expected key.path=value"},
      {"solver.iterations=", "has no value; write solver.iterations=VALUE"},
      {"solver.iterations=  ", "has no value"},
      {"solver..iterations=4", "is no path of keys"},
      {".=4", "is no path of keys"},
      {"[0]=4", "is no path of keys"},
      {"bodies[0=4", "is no path of keys"},
      {"a.b.c.d.e.f.g.h.i.j=4", "is no path of keys"},
      {"bodies.1.count=4", "bodies is a list of 1, \"1\" is no index of it"},
      {"bodies.x.count=4", "\"x\" is no index of it"},
      {"bodies.-1.count=4", "\"-1\" is no index of it"},
      {"bodies[0].radius=4", "belongs to shape sphere, cylinder, this body is a block"},
      {"time.step.x=4", "time.step is no block, it has no key \"x\""},
      {"gravity.0=[", "not valid YAML"},
      {"gravity.7=1", "gravity is a list of 3"},
      {"solver.iterations=1\n---\n2", "a second document"},
      {"name=&a x", "anchors"},
      {"fluid=off", "fluid: expected a block"},
      {"fluid=~", "fluid: expected a block"},
      {"solver.iterations=~", "has no value"},
      {"bodies=off", "expected a list of at least one body"},
  };
  for (const auto& [argument, message] : cases) {
    const std::string error = parse_error(kMinimal + "gravity: [0, 0, -9.81]\n", {argument});
    CAPTURE(argument, message, error);
    CHECK(contains(error, message));
    CHECK(error.rfind("2 --set " + one_line(argument) + ": ", 0) == 0);
  }
  CHECK(contains(parse_error(kMinimal, {"name=\xff"}), "not UTF-8"));
}

}  // namespace pbf::scene_test
