// Obstacles that the fluid moves, as a user runs them: files, plan, pictures, resume, compare.
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/in_pieces.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;

namespace {

void write_floating_box(const Scratch& folder) {
  folder.write("s.yaml",
               "name: s\n"
               "domain: {min: [0, 0, 0], max: [0.6, 0.4, 0.6]}\n"
               "fluid: {spacing: 0.025}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.6, 0.4, 0.2]}]\n"
               "obstacles:\n"
               "  - {name: crate, shape: box, center: [0.3, 0.2, 0.32], size: [0.15, 0.15, 0.15],\n"
               "     turn_axis: [0, 1, 0], turn_angle: 20, free: {density: 500}}\n"
               "time: {step: 0.002, end: 0.2}\n"
               "measure_every: 5\n"
               "output: {every: 0.02}\n");
}

}  // namespace

TEST_CASE("free bodies: frames, log, plan and summary say where they are") {
  const Scratch folder;
  write_floating_box(folder);
  const Outcome run = pbf::test::pbf({"run", "s.yaml", "--out", "a"}, folder.path());
  REQUIRE(run.code == 0);
  CHECK(has(run.out, "body crate"));
  CHECK(has(run.out, "of what moves, free bodies too"));
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  const auto time = reader.log_column("time"), z = reader.log_column("pose/crate/z"),
             spin = reader.log_column("pose/crate/spin_y");
  REQUIRE(reader.frames() == 11);
  for (std::int64_t k = 0; k < reader.frames(); ++k) {
    const auto bodies = reader.bodies(k);
    REQUIRE(bodies.size() == 1);
    bool found = false;
    for (std::size_t row = 0; row < time.size(); ++row)
      if (std::abs(time[row] - reader.times()[std::size_t(k)]) < 1e-9) {
        found = true;
        CHECK(bodies[0].middle[2] == z.at(row));
        CHECK(bodies[0].spin[1] == spin.at(row));
      }
    CHECK(found);
  }
  CHECK(reader.bodies(0)[0].middle[2] == Approx(0.32));
  CHECK(reader.bodies(10)[0].middle[2] < 0.31);  // it has fallen into the pool
  const Outcome plan = pbf::test::pbf({"plan", "s.yaml"}, folder.path());
  CHECK(has(plan.out, "crate: 1.6875 kg, 500 kg/m^3"));
  CHECK(has(pbf::test::pbf({"plan", "s.yaml", "--json"}, folder.path()).out, "\"free_bodies\""));
}

TEST_CASE("free bodies: stopped and resumed, the same bytes, and compare says so", "[slow]") {
  const Scratch folder;
  write_floating_box(folder);
  std::vector<std::string> set{"--set", "time.end=0.6"};
  if (GENERATE(false, true)) set.insert(set.end(), {"--set", "time.adaptive=on"});
  REQUIRE(run_scene(folder, "a", set).code == 0);
  run_in_pieces(folder, "b", 0.1, set);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
  const Outcome same = pbf::test::pbf({"compare", "a", "b"}, folder.path());
  CHECK(same.code == 0);
  CHECK(has(same.out, "all are in the same places"));
}

TEST_CASE("free bodies: on two sides, the poses are compared") {
  const Scratch folder;
  write_floating_box(folder);
  const Outcome o = pbf::test::pbf({"compare", "s.yaml", "--between", "cpu:double,cpu:float",
                                    "--warmup", "40", "--updates", "10", "--quiet"},
                                   folder.path());
  CAPTURE(o.out);
  CHECK(o.code == 0);
  CHECK(has(o.out, "poses: crate z"));
}
