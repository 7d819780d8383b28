// Which problem of the page of settings a scene looks like.
#include "lib/program/settings_row.h"

#include "tests/support/catch.h"
#include "tests/support/flume.h"

namespace pbf {
namespace {

using namespace scene_test;

std::string row_of(const Scene& s) {
  const auto row = program_module::settings_row(s);
  return row ? row->row : "none";
}
std::string row_of(const std::string& more, const std::vector<std::string>& set = {}) {
  return row_of(parse(kMinimal + more, set));
}

}  // namespace

TEST_CASE("settings: what falls, moves, rests or makes waves has its row of the page") {
  const std::string wide = "bodies=[{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}]",
                    column = "bodies=[{shape: block, min: [0, 0, 0], max: [0.5, 1, 0.8]}]",
                    post =
                        "obstacles=[{name: a, shape: box, min: [0.7, 0.4, 0], max: [0.8, 0.6, "
                        "1], loads: true}]";
  CHECK(row_of(flume(kRegular)) == "waves");
  CHECK(row_of("", {wide}) == "still_tank");
  CHECK(row_of("", {wide, "fluid.spacing=0.01"}) == "deep_tank");
  CHECK(row_of("", {wide, "tank_motion={kind: sine, amplitude: 5, period: 1, axis: [0, 1, 0]}"}) ==
        "sloshing");
  CHECK(row_of("", {wide, "settle={gravity: [0.5, 0, -9.8]}"}) == "standing_wave");
  CHECK(row_of("", {column}) == "dam_break");
  CHECK(row_of("", {column, post}) == "impact_loads");
  CHECK(row_of("", {wide, post}) == "still_tank");
  CHECK(row_of("", {column, "gravity=[0, 0, 0]"}) == "none");
  const auto blocks = [](const std::string& list) { return "bodies=[" + list + "]"; };
  const std::string pool = "{shape: block, min: [0, 0, 0], max: [1, 1, 0.3]}",
                    upper = "{shape: block, min: [0, 0, 0.3], max: [1, 1, 0.6]}",
                    above = "{shape: block, min: [0, 0, 0.6], max: [1, 1, 0.9]}",
                    ball = "{shape: sphere, center: [0.5, 0.5, 0.7], radius: 0.15}";
  CHECK(row_of("", {blocks(above)}) == "dam_break");
  CHECK(row_of("", {blocks(pool + "," + above)}) == "dam_break");
  CHECK(row_of("", {blocks(pool + "," + ball)}) == "dam_break");
  CHECK(row_of("", {blocks(pool + "," + upper)}) == "still_tank");
  CHECK(row_of("", {blocks(pool + "," + upper), "fluid.spacing=0.0125"}) == "deep_tank");
  CHECK(row_of("", {blocks(above), "gravity=[0, 0, 9.81]"}) == "dam_break");
  CHECK(row_of("", {blocks("{shape: block, min: [0, 0, 0.5], max: [1, 1, 1]}"),
                    "gravity=[0, 0, 9.81]"}) == "still_tank");
  CHECK(row_of("", {wide, "settle={gravity: [0, 0, -5]}"}) == "still_tank");
  CHECK(row_of("", {wide, "gravity=[3, 0, -9]"}) == "none");
  // Beside a box that reaches out of the water, and over one that lies in it.
  CHECK(row_of("", {blocks("{shape: block, min: [0.3, 0, 0], max: [1, 1, 0.5]}"),
                    "obstacles=[{name: a, shape: box, min: [0, 0, 0], max: [0.3, 1, 1]}]"}) ==
        "still_tank");
  CHECK(row_of("", {wide,
                    "obstacles=[{name: a, shape: box, min: [0.2, 0.2, 0], max: [0.6, 0.6, "
                    "0.2]}]"}) == "still_tank");
}

TEST_CASE("settings: scenes that the page does not have get no row") {
  CHECK(row_of("", {"bodies=[{shape: block, min: [0, 0, 0], max: [1, 1, 0.5], velocity: [1, 0, "
                    "0]}]"}) == "none");
  CHECK(row_of("obstacles: [{name: a, shape: box, min: [0.4, 0.4, 0.3], max: [0.6, 0.6, 0.5], "
               "motion: {kind: velocity, angular: [0, 0, 1]}}]\n") == "none");
}

}  // namespace pbf
