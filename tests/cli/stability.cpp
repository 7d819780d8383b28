// pbf stability, and what the guard leaves behind in a run folder.
#include <chrono>
#include <csignal>
#include <thread>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

const char* const kSuite =
    "cases:\n"
    "  - {name: good, group: one, scene: tiny.yaml, must: {speed: 100}}\n"
    "  - {name: bad, group: two, scene: tiny.yaml, must: {speed: 1.0e-6}}\n";

}  // namespace

TEST_CASE("stability: a table and a CSV with a verdict per case, exit 6 when one fails", "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("suite.yaml", kSuite);
  const Outcome good =
      pbf::test::pbf({"stability", "one", "--suite", "suite.yaml", "--quiet"}, folder.path());
  CHECK(good.code == 0);
  CHECK(has(good.out, "1 cases on cpu float: 0 failed"));
  const Outcome all = pbf::test::pbf(
      {"stability", "--suite", "suite.yaml", "--csv", "t.csv", "--jobs", "2"}, folder.path());
  CHECK(all.code == 6);
  CHECK(has(all.out, "FAIL"));
  const std::string csv = read_text(folder / "t.csv");
  CHECK(has(csv, "case,group,backend,precision"));
  CHECK(has(csv, "good,one,cpu,float,full,64,20,"));
  CHECK(has(csv, "bad,two,"));
  const Outcome none =
      pbf::test::pbf({"stability", "three", "--suite", "suite.yaml"}, folder.path());
  CHECK(none.code == 2);
  CHECK(has(none.err, "no case or group three"));
  CHECK(pbf::test::pbf({"stability", "--suite", "none.yaml"}, folder.path()).code == 2);
}

TEST_CASE("stability: SIGTERM ends it with 75, and the cases done until then are written",
          "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write(
      "suite.yaml",
      "cases:\n"
      "  - {name: short, group: one, scene: tiny.yaml, must: {speed: 100}}\n"
      "  - {name: endless, group: one, scene: tiny.yaml, set: {time.end: 1.0e+5}, must: {}}\n");
  Outcome o;
  for (const int ms : {300, 1000, 3000, 10000, 30000}) {  // a busy machine may need long
    Process suite({"stability", "--suite", "suite.yaml", "--csv", "t.csv", "--jobs", "1"},
                  folder.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    suite.send(SIGTERM);
    o = suite.wait();
    if (has(o.err, "with 1 of 2 cases done")) break;
  }
  CAPTURE(o.err, o.out);
  CHECK(o.code == 75);
  CHECK(has(o.err, "stopped early by SIGTERM with 1 of 2 cases done"));
  CHECK(has(o.out, "1 cases on cpu float: 0 failed"));
  CHECK(has(read_text(folder / "t.csv"), "\nshort,one,"));
  CHECK(!has(read_text(folder / "t.csv"), "endless"));
}

TEST_CASE("stability: a line of progress every ten seconds without a terminal", "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  Args map{"stability",     "tiny.yaml", "--map",    "time.step,gravity", "--x",
           "1e-5:1e-4:400", "--y",       "1:10:400", "--iterations",      "4",
           "--csv",         "map.csv"};
  Process maps(map, folder.path());
  std::this_thread::sleep_for(std::chrono::seconds(13));
  maps.send(SIGINT);
  const Outcome o = maps.wait();
  CAPTURE(o.err);
  CHECK(o.code == 75);
  CHECK(has(o.err, " of 160000 runs, "));
  CHECK(count(o.err, " of 160000 runs, ") <= 3);
  CHECK(has(o.err, "stopped early by SIGINT with "));
}

TEST_CASE("stability: JUnit XML of a suite, which no map has", "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("suite.yaml", kSuite);
  folder.write("t.xml", "what was there");
  const Args suite{"stability", "--suite", "suite.yaml", "--quiet", "--junit"};
  const auto with = [&](Args more) {
    more.insert(more.begin(), suite.begin(), suite.end());
    return pbf::test::pbf(more, folder.path());
  };
  CHECK(with({"t.xml"}).code == 6);
  const std::string xml = read_text(folder / "t.xml");
  CHECK(has(xml, "<testsuite name=\"pbf stability\" tests=\"2\" failures=\"1\""));
  CHECK(has(xml, "<testcase classname=\"one\" name=\"good\" time=\"0."));
  CHECK(has(xml, "<failure message=\"lost 0, speed "));
  CHECK(with({"t.csv", "--csv", "t.csv"}).code == 2);
  CHECK(with({"none/t.xml"}).code == 5);
  const Outcome input = with({"tiny.yaml"});  // told before the cases are run
  CHECK(input.code == 2);
  CHECK(input.out == "");
  CHECK(with({"m.xml", "--map", "time.step,gravity", "tiny.yaml"}).code == 2);
}

TEST_CASE("stability: a map is a CSV with a class per run") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const Outcome o =
      pbf::test::pbf({"stability", "tiny.yaml", "--map", "time.step,gravity", "--x", "0.002,0.004",
                      "--y", "5,10", "--iterations", "2", "--csv", "map.csv", "--quiet"},
                     folder.path());
  CHECK(o.code == 0);
  CHECK(has(o.out, "4 runs: "));
  CHECK(has(o.out, " degraded (mean compression above 1 %), "));
  const std::string csv = read_text(folder / "map.csv");
  CHECK(has(csv, "x_key,y_key,x,y,iterations,class,dt_hat,compression_mean"));
  CHECK(has(csv, "time.step,gravity,0.002,5"));
  for (const char* map : {"time.step", "time.step,gravity,x", "time.stp,gravity", "name,gravity"}) {
    const Outcome wrong =
        pbf::test::pbf({"stability", "tiny.yaml", "--map", map, "--quiet"}, folder.path());
    CHECK(wrong.code == 2);
    CHECK(has(wrong.err, "--map"));
  }
}

TEST_CASE("stability: help says what a map varies, and what its classes and numbers mean") {
  const Scratch folder;
  const Outcome help = pbf::test::pbf({"stability", "--map", "--help"}, folder.path());
  CHECK(help.code == 0);
  for (const char* part :
       {"every combination of values of the two keys", "and of solver.iterations", "6 x 6 x 5 runs",
        "stable    it came to the end", "degraded  it came to the end", "stopped   the guard",
        "dt_hat is dt sqrt(g/h)", "1,2,4,8,16 when not given", "0.01 is 1 %"})
    CHECK(has(help.out, part));
  folder.write("tiny.yaml", tiny_scene());
  const Outcome said = pbf::test::pbf({"stability", "tiny.yaml", "--map", "time.step,gravity",
                                       "--x", "0.002,0.004", "--y", "5", "--iterations", "1,2"},
                                      folder.path());
  CHECK(
      has(said.err, "4 runs of tiny.yaml: 2 values of time.step, 1 of gravity, 2 of solver.iter"));
  // What is of the suite alone is refused, where it did nothing.
  for (const Args& more : {Args{"--reduced"}, Args{"--suite", "suite.yaml"}}) {
    Args args{"stability", "tiny.yaml", "--map", "time.step,gravity"};
    args.insert(args.end(), more.begin(), more.end());
    const Outcome o = pbf::test::pbf(args, folder.path());
    CHECK(o.code == 2);
    CHECK(has(o.err, "--map"));
  }
}

TEST_CASE(
    "guard: a run that blows up ends with exit 3, says where, and leaves a scene that repeats "
    "it, and without the guard it goes on",
    "[slow]") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  const std::vector<std::string> blow{"run", scene, "--out", "o", "--set", "tensile.k=1000"};
  const Outcome o = pbf::test::pbf(blow, folder.path());
  CHECK(o.code == 3);
  for (const char* part : {"stopped by the guard: at update ", ", in stage delta of iteration ",
                           ", particle ", " m, velocity (", "time.step", "guard_scene.yaml"})
    CHECK(has(o.err, part));
  CHECK(has(read_text(folder / "o/log.txt"), "stopped by the guard"));
  CHECK(pbf::RunReader((folder / "o/run.vtkhdf").string()).status() == "diverged");
  CHECK_FALSE(fs::exists(folder / "o/DONE"));
  CHECK(has(read_text(folder / "o/guard_scene.yaml"), "prestabilize: false"));
  const Outcome again = pbf::test::pbf({"run", "o/guard_scene.yaml", "--out", "p"}, folder.path());
  CHECK(again.code == 3);
  const auto told = [](const std::string& text) {  // stage, iteration and particle
    const std::size_t from = text.find(", in stage"), id = text.find(", particle ", from);
    return text.substr(from, text.find(" at ", id) - from);
  };
  CHECK(has(told(o.err), ", particle "));
  CHECK(told(o.err) == told(again.err));
  std::vector<std::string> off = blow;
  off.insert(off.end(), {"--overwrite", "--set", "guard=off"});
  CHECK(pbf::test::pbf(off, folder.path()).code == 0);
}

TEST_CASE("guard: the scene that repeats an event names the particle by the id that it had",
          "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  // A first update with tensile, and one after the particles have been sorted, with viscosity.
  for (const char* key : {"tensile.k=1", "viscosity.xsph=6"}) {
    CAPTURE(key);
    const Outcome o =
        pbf::test::pbf({"run", "tiny.yaml", "--out", "o", "--overwrite", "--set", key, "--set",
                        "guard.energy=0.01", "--set", "bodies[0].velocity=[1,2,0]"},
                       folder.path());
    REQUIRE(o.code == 3);
    const Outcome again =
        pbf::test::pbf({"run", "o/guard_scene.yaml", "--out", "p", "--overwrite"}, folder.path());
    CHECK(again.code == 3);
    const auto particle = [](const std::string& text) {
      const std::size_t from = text.find(", particle ");
      return text.substr(from, text.find(" m, ", from) - from);
    };
    CHECK(has(particle(o.err), " at ("));
    CHECK(particle(o.err) == particle(again.err));
  }
}

TEST_CASE("speed limit: the summary says how often a particle was slowed down") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  const Outcome o =
      pbf::test::pbf({"run", scene, "--out", "o", "--set", "bodies[0].velocity=[3,0,0]", "--set",
                      "solver.speed_limit=0.01"},
                     folder.path());
  CHECK(o.code == 0);
  CHECK(has(o.out, "times a particle was slowed down to"));
}
