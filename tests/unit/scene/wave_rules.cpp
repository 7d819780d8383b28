// What a scene may say of wave makers, and every error about them with its remedy.
#include "tests/support/catch.h"
#include "tests/support/flume.h"

namespace pbf::scene_test {
namespace {

const std::string kHigh = "kind: regular_waves, direction: [1, 0, 0], period: 2, height: ";
const std::string kSolitaryOf = "kind: solitary_waves, direction: [1, 0, 0], heights: ";
const std::string kSeaOf = "kind: irregular_waves, direction: [1, 0, 0], height: 0.05, period: 1.5";
const std::string kFocus =
    "kind: focused_waves, direction: [1, 0, 0], crest: 0.06, period: 1.5, time: 12, place: ";
const std::string kFlap =
    "kind: regular_waves, height: 0.04, period: 1.2, axis: [0, 1, 0], pivot: [0.2, 0, 0.1]";

void says(const std::string& motion, const std::string& text,
          const std::vector<std::string>& set = {}) {
  const std::string error = flume_error(motion, set);
  CAPTURE(motion, error);
  CHECK(contains(error, "2 scene.yaml:7:"));
  CHECK(contains(error, text));
}

}  // namespace

TEST_CASE("wave makers: every kind with its keys is read and written back") {
  for (const std::string& motion :
       {kRegular + ", order: 1, ramp: 1, depth: 0.3, gain: 1.1, start: 0.5, breaking: true", kFlap,
        kSeaOf + ", spectrum: pierson_moskowitz, gamma: 2, seed: 7, repeat: 60, band: [0.5, 2], "
                 "amplitudes: random",
        kSolitaryOf + "[0.02, 0.01], times: [0, 5], theory: boussinesq",
        kFocus + "6, band: [0.5, 2.5], components: 32, phase: 90"}) {
    CAPTURE(motion);
    const Scene s = parse(flume_text(motion));
    CHECK(parse(resolved_yaml(s)) == s);
    CHECK(flume_error(motion) == "no error");
  }
  CHECK(parse(flume_text(kRegular)).obstacles[0].motion->ramp == std::nullopt);
}

TEST_CASE("wave makers: what is missing, misplaced or contradicts is named with its remedy") {
  says("kind: regular_waves, height: 0.06, period: 2",
       "obstacles[0].motion: a wave maker needs direction, which makes it a piston, or axis and "
       "pivot of a flap; give one");
  says(kFlap + ", direction: [1, 0, 0]", "of a flap, not both; give one");
  says("kind: regular_waves, height: 0.06, period: 2, direction: [1, 0, 1]",
       "obstacles[0].motion.direction: waves run along x or y; give [1, 0, 0]");
  says("kind: regular_waves, height: 0.06, period: 2, axis: [0, 1, 1], pivot: [0, 0, 0]",
       "obstacles[0].motion.axis: waves run along x or y");
  says("kind: regular_waves, height: 0.06, period: 2, axis: [1, 0, 0], pivot: [0, 0, 0]",
       "obstacles[0].motion.axis: with dimensions: 2 nothing turns but about y");
  says("kind: regular_waves, height: 0.06, period: 2, direction: [0, 1, 0]",
       "obstacles[0].motion.direction: its y component is 1");
  says("kind: regular_waves, height: 0.06, period: 2, axis: [0, 1, 0]",
       "obstacles[0].motion: a flap needs pivot, a point of its hinge; give one");
  says(kRegular + ", pivot: [0, 0, 0]", "obstacles[0].motion.pivot: is the hinge of a flap");
  says(kFlap + ", order: 2", "obstacles[0].motion.order: 2 is known of pistons alone; give 1");
  says("kind: regular_waves, height: 0.04, period: 1.2, axis: [0, 1, 0], pivot: [0.2, 0, 0.35]",
       "obstacles[0].motion.pivot: is 0.35 m above the floor, the water is 0.3 m deep");
  says(kRegular, "obstacles[0].motion: waves need gravity along -z", {"gravity=[1, 0, -9.81]"});
  says(kRegular + ", gamma: 2", "obstacles[0].motion.gamma: belongs to kind irregular_waves");
  says(kSolitaryOf + "[0.02], axis: [0, 1, 0]", "obstacles[0].motion.axis: belongs to kind ");
  says(kSolitaryOf + "[0.02, 0.01]",
       "obstacles[0].motion.times: has 1 numbers, heights has 2; give one of each wave");
  says(kSolitaryOf + "[0.02, 0.01], times: [4, 0]", "obstacles[0].motion.times: must ascend");
  says(kSeaOf + ", band: [2, 1]",
       "obstacles[0].motion.band: its lowest frequency 2 is not below its highest, 1");
  says(kSeaOf + ", repeat: 0.3", "obstacles[0].motion.repeat: makes 0 lines in the band");
  says(kSeaOf + ", repeat: 10800",
       "obstacles[0].motion.repeat: makes 18721 lines, and the motion has 1380000 rows: too many "
       "sines to add up. Give 834 s or less",
       {"time.end=10800"});
  says(kFocus + "0.1",
       "obstacles[0].motion.place: is 0.1, and the paddle stands at 0.2; give a place ahead of it");
}

TEST_CASE("wave makers: only a box makes waves") {
  std::string text = flume_text(kRegular);
  const std::string box = "shape: box, min: [-0.3, 0, 0], max: [0.2, 0.01, 0.6]";
  text.replace(text.find(box), box.size(), "shape: sphere, center: [0.1, 0.01, 0.3], radius: 0.1");
  CHECK(contains(parse_error(text),
                 "obstacles[0].shape: a wave maker is a box; give that, or its motion as a table"));
}

TEST_CASE("wave_breaks: waves that break at the paddle are refused with the limit and its name") {
  says(kHigh + "0.24",
       "obstacles[0].motion.height: 0.24 m is above 0.234 m, at which waves break "
       "here (McCowan, 0.78 of the depth); lower it, or give breaking: true");
  CHECK_FALSE(contains(flume_error(kHigh + "0.24, breaking: true"), "at which waves break"));
  says("kind: regular_waves, direction: [1, 0, 0], period: 0.7, height: 0.12",
       "(Miche, 0.142 L tanh kD); lower it");
  says(kSolitaryOf + "[0.02, 0.25], times: [0, 5]",
       "obstacles[0].motion.heights: 0.25 m is above 0.234 m");
  CHECK(flume_error(kHigh + "0.08") == "no error");
}

TEST_CASE("wave_depth: a depth that the lattice does not fill is refused with spacings that fit") {
  const std::vector<std::string> set{"bodies.0.max=[8, 0.218]"};
  says(kRegular + ", depth: 0.218",
       "obstacles[0].motion.depth: is 0.218 m, and the blocks are filled to 0.21 m, in which long "
       "waves are 1.9 % slower; give auto, or blocks of this height and fluid.spacing 0.009909",
       set);
  CHECK(flume_error(kRegular + ", depth: 0.218", {set[0], "fluid.spacing=0.00990909"}) ==
        "no error");
  CHECK(flume_error(kRegular, set) == "no error");
  says(kRegular, "obstacles[0].motion.depth: auto is the level of blocks that stand on the floor",
       {"bodies.0.min=[0.2, 0.1]"});
}

TEST_CASE("wave_resolution: waves below two spacings are refused with the spacing that they take") {
  says(kHigh + "0.015",
       "obstacles[0].motion.height: makes waves of 1.5 spacings, which are lost; give "
       "fluid.spacing 0.003 or less");
}

TEST_CASE("wave_stroke: a paddle out of its wall or beyond the middle, a flap of 30 degrees") {
  says(kRegular,
       "obstacles[0].motion: moves by 0.05271 m at 0.4531 s, and the back of its box comes",
       {"obstacles.0.min=[-0.03, 0]", "obstacles.0.motion.ramp=0"});
  says(kRegular, "m out of the wall x_min; give the box 0.02", {"obstacles.0.min=[-0.03, 0]"});
  says(kSolitaryOf + "[0.1]", "and its front passes the middle of the tank at 4 m; lower",
       {"obstacles.0.min=[-1, 0]", "obstacles.0.max=[3.8, 0.6]", "bodies.0.min=[3.8, 0]"});
  says("kind: regular_waves, height: 0.1, period: 2, axis: [0, 1, 0], pivot: [0.2, 0, 0.2]",
       "obstacles[0].motion: turns by ");
  says("kind: regular_waves, height: 0.1, period: 2, axis: [0, 1, 0], pivot: [0.2, 0, 0.2]",
       "at most 30 are possible; lower the waves, or put its hinge deeper");
  says(kRegular, "obstacles[0].motion: needs 5.12e+06 rows, 64 in the shortest period",
       {"time.end=40000", "obstacles.0.motion.period=1", "obstacles.0.motion.height=0.05"});
}

}  // namespace pbf::scene_test
