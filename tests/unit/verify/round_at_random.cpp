// Which numbers of a scene the members of a comparison have rounded: all, but for those that say
// why not.
#include <cmath>

#include "lib/scene/key_rows.h"
#include "lib/verify/compare_parts.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

enum class Form { disc, pipe };
struct Gate {
  Form form = Form::disc;
  double radius = 3, length = 5;
};
struct Pump {
  double rate = 7;
  std::optional<double> head;
};
struct Log {
  double every = 11;
  Double3 place{1, 2, 3};
};
struct Tank {
  double depth = 2;
  Double3 wind{1, -2, 0};
  std::optional<std::array<double, 2>> band;
  double damping = 1;
  double end = 13;
  double unit = 17;
  int count = 19;
  std::vector<Gate> gates{{Form::disc}, {Form::pipe}};
  std::optional<Pump> pump;
  std::optional<Log> log = Log{};
};

const KeyTable& tank_table() {
  static Tank defaults;
  static const Range any{-100, 100};
  static const KeyTable table(
      {{{{"", "A tank."},
         list_block(MEMBER(Tank, gates), "Gates", {.entry_name = "gate"}),
         optional_block(MEMBER(Tank, pump), "Pump."),
         optional_block(MEMBER(Tank, log), "Log.", exact("not computed with"))},
        {key(MEMBER(Tank, depth), number("m", any), "Depth."),
         key(MEMBER(Tank, wind), number("m/s", any), "Wind."),
         key(MEMBER(Tank, band), number("m", any), "Band.", automatic),
         key(MEMBER(Tank, damping), number("", any), "Damping.", off_at(1)),
         key(MEMBER(Tank, end), number("s", any), "End.", effect(Effect::none)),
         key(MEMBER(Tank, unit), number("m", any), "Unit.", exact("a unit")),
         key(MEMBER(Tank, count), number("", any), "Count."),
         key(MEMBER_OF(gates, Gate, form), one_of({"disc", "pipe"}), "Form.", is_kind),
         key(MEMBER_OF(gates, Gate, radius), number("m", any), "Radius."),
         key(MEMBER_OF(gates, Gate, length), number("m", any), "Length.", of(Form::pipe)),
         key(MEMBER(Tank, pump->rate), number("m/s", any), "Rate."),
         key(MEMBER(Tank, pump->head), number("m", any), "Head.", automatic),
         key(MEMBER(Tank, log->every), number("s", any), "Every."),
         key(MEMBER(Tank, log->place), number("m", any), "Place.")}}},
      object(defaults));
  return table;
}

constexpr double kRoundoff = 1e-3;

Tank rounded(Tank tank, std::uint64_t seed = 1) {
  round_at_random(tank_table(), object(tank), kRoundoff, seed);
  return tank;
}

void check_rounded(double value, double from) {
  CHECK(value != from);
  CHECK(std::fabs(value - from) <= kRoundoff * std::fabs(from));
}

}  // namespace

TEST_CASE("a comparison rounds every real number of a table whose rows say nothing of it") {
  Tank tank;
  tank.band = {{1, 4}};
  tank.damping = 0.5;
  tank.pump = Pump{};
  const Tank r = rounded(tank);
  check_rounded(r.depth, 2);
  check_rounded(r.wind[0], 1);
  check_rounded(r.wind[1], -2);
  CHECK(r.wind[2] == 0);
  check_rounded((*r.band)[0], 1);
  check_rounded((*r.band)[1], 4);
  check_rounded(r.damping, 0.5);
  check_rounded(r.pump->rate, 7);
  CHECK_FALSE(r.pump->head);
  check_rounded(r.gates[0].radius, 3);
  check_rounded(r.gates[1].radius, 3);
  check_rounded(r.gates[1].length, 5);
  CHECK(rounded(tank).depth == r.depth);
  CHECK(rounded(tank, 2).depth != r.depth);
}

TEST_CASE("a comparison leaves alone what results do not depend on, and what says why") {
  const Tank r = rounded({});
  CHECK(r.end == 13);             // no effect
  CHECK(r.unit == 17);            // exact
  CHECK(r.count == 19);           // whole
  CHECK(r.damping == 1);          // off
  CHECK(r.gates[0].length == 5);  // of another kind
  CHECK(r.log->every == 11);      // in a block that is exact
  CHECK(r.log->place == Double3{1, 2, 3});
  CHECK_FALSE(r.pump);
}

TEST_CASE("a key has the same random number whatever else a table has") {
  Tank with;
  with.pump = Pump{};
  Tank more = with;
  more.band = {{1, 4}};
  more.damping = 0.5;
  CHECK(rounded(with).pump->rate == rounded(more).pump->rate);
  CHECK(rounded(with).depth / 2 != rounded(with).pump->rate / 7);
}

TEST_CASE("the numbers of a scene that a comparison rounds are those that enter the arithmetic") {
  Scene scene = parse(kMinimal + "tensile: on\nviscosity: on\nvorticity: on\nrender: on\n",
                      {"gravity=[1,2,-9]", "solver.sor=0.5", "solver.velocity_damping=0.9",
                       "solver.wall_margin=0.01", "solver.speed_limit=1", "fluid.mass=1.1",
                       "time.adaptive=on", "solver.tolerance=0.001", "guard.speed=9"});
  Scene r = scene;
  round_at_random(scene_table(), object(r), 1e-3, 5);
  const auto pairs = [](Scene& s) {
    return std::vector<double*>{&s.time.step,       &s.fluid.smoothing_ratio,
                                &s.solver.cfm,      &s.solver.wall_margin,
                                &s.gravity[0],      &s.gravity[1],
                                &s.gravity[2],      &s.solver.velocity_damping,
                                &*s.solver.sor,     &*s.fluid.mass,
                                &s.tensile->k,      &s.tensile->delta_q,
                                &s.viscosity->xsph, &s.vorticity->epsilon};
  };
  const std::vector<double*> now = pairs(r), before = pairs(scene);
  for (std::size_t k = 0; k < now.size(); ++k) {
    check_rounded(*now[k], *before[k]);
    *now[k] = *before[k];
  }
  CHECK(r == scene);  // nothing else
}

}  // namespace pbf::scene_test
