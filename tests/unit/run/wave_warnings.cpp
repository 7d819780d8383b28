// What is told of waves before a run, and the file that a run keeps of its wave maker.
#include "lib/run/wave_files.h"

#include "lib/program/motion.h"
#include "lib/scene/waves.h"
#include "tests/support/catch.h"
#include "tests/support/flume.h"

namespace pbf::scene_test {
namespace {

const std::string kSeaOfHeight =
    "kind: irregular_waves, direction: [1, 0, 0], period: 1.5, repeat: 60, height: ";

/// The text of this kind; empty if there is none.
std::string told(const std::string& kind, const std::string& motion,
                 const std::vector<std::string>& set = {}) {
  const Scene s = flume(motion, set);
  for (const Warning& w : scene_warnings({s, "."}, count_particles(s, ".")))
    if (w.kind == kind) return w.text;
  return "";
}

}  // namespace

TEST_CASE("waves: a flume with the settings for waves gives no warning but of its resolution") {
  const Scene s =
      flume(kRegular, {"fluid.spacing=0.005", "time.step=0.002", "domain.max=[8, 0.005, 0.6]"});
  for (const Warning& w : wave_warnings(s)) CHECK(w.text == "");
}

TEST_CASE("wave_breaks: the highest waves of a sea that break are told") {
  CHECK(told("wave_breaks", kSeaOfHeight + "0.05").empty());
  CHECK(contains(told("wave_breaks", kSeaOfHeight + "0.13"),
                 "obstacles[0] (paddle): its highest waves, about 0.234 m, are above 0.2"));
}

TEST_CASE("wave_theory: the range of each order is told with the free wave that runs along") {
  CHECK(told("wave_theory", kRegular).empty());
  CHECK(contains(told("wave_theory", kRegular + ", order: 1"),
                 "with order 1 and H L^2/D^3 = 23.6, above 5, a free wave of half the period runs "
                 "along, of 0.19"));
  CHECK(contains(told("wave_theory",
                      "kind: regular_waves, direction: [1, 0, 0], height: 0.06, "
                      "period: 2.5"),
                 "theory of second order holds up to H L^2/D^3 = 26.3, and it is "));
  CHECK(contains(told("wave_theory",
                      "kind: focused_waves, direction: [1, 0, 0], crest: 0.06, "
                      "period: 1.5, place: 6, time: 5"),
                 "its slowest waves are not at place 6 at time 5: "));
}

TEST_CASE("wave_resolution: few spacings and much loss are told with the spacing that helps") {
  const std::string text = told("wave_resolution",
                                "kind: regular_waves, direction: [1, 0, 0], "
                                "height: 0.04, period: 0.8");
  CHECK(contains(text, "waves are 4 spacings high, below 5, they will lose about "));
  CHECK(contains(text, "% of their height per wavelength (estimate), above 10; give "));
  CHECK(contains(
      told("wave_resolution", kRegular, {"bodies.0.max=[8, 0.15]", "obstacles.0.min=[-0.5, 0]"}),
      "the water is 15 spacings deep, below 20"));
}

TEST_CASE("wave_step: few steps in a period are told") {
  CHECK(told("wave_step", kRegular).empty());
  CHECK(contains(told("wave_step", kRegular, {"time.step=0.025", "output.gauges_every=0.1"}),
                 "80 steps in a period, below 100; give time.step 0.02 or less"));
}

TEST_CASE("wave_settings: levels that are off and a long h are told with the settings for waves") {
  CHECK(told("wave_settings", kRegular).empty());
  CHECK(
      contains(told("wave_settings", kRegular, {"fluid.smoothing_ratio=3.5"}),
               "obstacles[0] (paddle): waves lose about 6.1 % of their height per wavelength with "
               "h = 3.5 d, 2.7 % with fluid.smoothing_ratio 2 (configs/SETTINGS.md)"));
  CHECK(contains(told("wave_settings", kRegular, {"solver.levels=off"}),
                 "without solver.levels waves lose height and run too fast; for waves give "
                 "solver: {iterations: 1, substeps: 7, levels: on} (configs/SETTINGS.md)"));
}

TEST_CASE("wave_returns: the time at which waves are back is told unless something stops them") {
  CHECK(told("wave_returns", kRegular).empty());
  const std::vector<std::string> longer{"time.end=12"};
  CHECK(contains(told("wave_returns", kRegular, longer),
                 "the first wave is back at the paddle at 10.6 s, and time.end is 12 s; give a "
                 "slope or a sponge (damping) at the far end"));
  CHECK(told("wave_returns", kRegular, {"time.end=12", "domain.open=[x_max]"}).empty());
  const std::string zone = "damping=[{name: end, min: [6, 0, 0], max: [8, 1, 1]}]";
  CHECK(told("wave_returns", kRegular, {"time.end=12", zone}).empty());
}

TEST_CASE("wave_sponge: a zone at the paddle, and one that is too short to end waves, are told") {
  const auto zone = [](const char* from, const char* rest = "") {
    return told("wave_sponge", kRegular,
                {std::string("damping=[{name: end, min: [") + from + ", 0, 0], max: [8, 1, 1]" +
                 rest + "}]"});
  };
  CHECK(zone("4.5").empty());  // a wave of 3.26 m
  CHECK(contains(zone("6.6"),
                 "obstacles[0] (paddle): the zone end of damping has 0.43 of a wavelength and "
                 "reflects about 0."));
  CHECK(contains(zone("6.6"), "half a wavelength (1.63 m) is the least"));
  CHECK(contains(zone("1"), "the zone end of damping begins "));
  CHECK(contains(zone("1"), "closer than half a wavelength (1.63 m)"));
  CHECK(zone("1", ", toward: x_min").empty());
  CHECK(zone("6.6", ", axes: [z]").empty());
}

TEST_CASE("waves_NAME.csv: as a table of a file it is the same motion, and has the gauges' waves") {
  const test::TemporaryFolder folder;
  for (const std::string& motion :
       {kRegular, std::string("kind: regular_waves, height: 0.04, period: 1.2, axis: [0, 1, 0], "
                              "pivot: [0.2, 0, 0.1]")}) {
    const Scene keys = flume(motion);
    const std::vector<WaveFile> files = wave_files(keys);
    REQUIRE(files.size() == 1);
    CHECK(files[0].name == "waves_paddle.csv");
    CHECK(is_wave_file(files[0].name));
    folder.write(files[0].name, files[0].text);
    Scene file = parse(flume_text("kind: file, path: waves_paddle.csv" +
                                  std::string(motion == kRegular ? "" : ", pivot: [0.2, 0, 0.1]")));
    read_linked_files(file, folder.path.string());
    const MotionTable &a = keys.obstacles[0].motion->table, &b = file.obstacles[0].motion->table;
    CHECK(a.columns == b.columns);
    CHECK(a.time == b.time);
    CHECK(a.values == b.values);
    const Pose p = pose_of(keys, keys.obstacles[0], 3.3), q = pose_of(file, file.obstacles[0], 3.3);
    CHECK(p.shift == q.shift);
    CHECK(p.turn == q.turn);
    CHECK(p.pivot == q.pivot);
    // The last row has the elevation 2.8 m from the paddle.
    const std::string last = files[0].text.substr(files[0].text.rfind(',') + 1);
    CHECK(std::stod(last) ==
          Approx(wave_maker(keys, keys.obstacles[0]).elevation(2.8, a.time.back())).margin(1e-9));
    CHECK(contains(files[0].text, ",eta_G_m\n"));
  }
}

TEST_CASE("tables of motion: columns of expected elevations are no part of the motion") {
  const test::TemporaryFolder folder;
  folder.write("p.csv", "t,x,y,z,eta_a_m,eta_b_m\n0,0,0,0,no,1\n9,0.1,0,0,2,3\n");
  Scene s = parse(flume_text("kind: file, path: p.csv"));
  read_linked_files(s, folder.path.string());
  CHECK(s.obstacles[0].motion->table.columns == 3);
  CHECK(s.obstacles[0].motion->table.values[1] == std::array<double, 6>{0.1});
  folder.write("p.csv", "t,x,y,z,eta_a_m,rx\n0,0,0,0,0,1\n9,0.1,0,0,2,3\n");
  CHECK(contains(error_of([&] { read_linked_files(s, folder.path.string()); }),
                 "expected the header t,x,y,z or"));
}

}  // namespace pbf::scene_test
