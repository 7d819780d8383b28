// The passes of an update. The expected sequences are written by hand from kernels/README.md ("The
// step") and the features' own rules.
#include "lib/program/program.h"
#include "lib/program/plan.h"

#include "tests/support/catch.h"
#include "tests/support/program_steps.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

using test::text;

const std::string kRound = "0-2(density+lambda, delta)";

}  // namespace

TEST_CASE("program: every feature has its passes where the step wants them, and no others") {
  struct Row {
    std::string more;
    std::vector<std::string> set;
    std::string update;
  };
  const std::string start = "predict, sort, lists, ";
  const Row row = GENERATE_COPY(
      Row{"", {}, start + kRound},
      Row{"", {"solver.fused=false"}, start + "0-2(density, lambda, delta)"},
      Row{"", {"solver.iterations=1"}, start + "0-0(density+lambda, delta)"},
      Row{"", {"viscosity.xsph=0.1"}, start + kRound + ", xsph"},
      Row{"", {"viscosity.xsph=0"}, start + kRound},
      Row{"", {"vorticity.epsilon=0.1"}, start + kRound + ", curl, confinement"},
      Row{"", {"vorticity.epsilon=0"}, start + kRound},
      Row{"",
          {"viscosity.xsph=0.1", "vorticity.epsilon=0.1"},
          start + kRound + ", xsph, curl, confinement"},
      Row{"", {"tensile.k=0.01"}, start + kRound},  // in the loop of delta
      Row{kTank, {}, "motion, " + start + kRound},
      Row{kStanding, {}, start + "near solids, " + kRound},
      // What moves does work, which is known from its load.
      Row{kWaveMaker, {}, "motion, " + start + "near solids, " + kRound + ", loads"},
      Row{kStanding, {"obstacles.0.loads=true"}, start + "near solids, " + kRound + ", loads"},
      Row{"", {"domain.loads=true"}, start + "near solids, " + kRound + ", loads"},
      Row{kFlow, {}, start + kRound + ", flow"}, Row{kLevelGauge, {}, start + kRound},
      Row{kFlow,
          {"viscosity.xsph=0.1", "domain.loads=true"},
          start + "near solids, " + kRound + ", xsph, loads, flow"},
      Row{"",
          {"solver.levels=on"},
          start + "level cells, 0-2(density+lambda, level multipliers, delta)"},
      Row{"",
          {"solver.levels=on", "domain.loads=true"},
          start + "near solids, level cells, 0-2(density+lambda, level multipliers, loads of the "
                  "levels, delta), loads"},
      // The levels push walls, not obstacles.
      Row{kStanding,
          {"solver.levels=on", "obstacles.0.loads=true"},
          start +
              "near solids, level cells, 0-2(density+lambda, level multipliers, delta), loads"});
  CAPTURE(row.more, row.set);
  CHECK(text(program_of(row.more, row.set).update) == row.update);
}

TEST_CASE("program: updates in a row are joined, and the first and last update have their ends") {
  struct Row {
    std::string more;
    std::vector<std::string> set;
    std::string first, next, last;
  };
  const Row row = GENERATE_COPY(
      Row{"", {}, "predict+sort", "predict+sort", ""},
      Row{"", {"viscosity.xsph=0.1"}, "predict+sort", "xsph+predict+sort", "xsph"},
      Row{"",
          {"viscosity.xsph=0.1", "vorticity.epsilon=0.1"},
          "predict+sort",
          "xsph, curl, confinement, predict+sort",
          "xsph, curl, confinement"},
      Row{"", {"domain.loads=true"}, "predict+sort", "loads, predict+sort", "loads"},
      Row{"",
          {"domain.loads=true", "viscosity.xsph=0.1"},
          "predict+sort",
          "xsph, loads, predict+sort",
          "xsph, loads"},
      Row{kTank, {}, "motion, predict+sort", "motion, predict+sort", ""},
      // Neither xsph nor delta may take particles along before what moves has moved.
      Row{kTank,
          {"viscosity.xsph=0.1"},
          "motion, predict+sort",
          "xsph, motion, predict+sort",
          "xsph"},
      Row{kFlow, {"viscosity.xsph=0.1"}, "predict+sort", "xsph, flow, predict+sort", "xsph, flow"});
  CAPTURE(row.more, row.set);
  const Program p = program_of(row.more, row.set);
  CHECK(p.has_pairs());
  CHECK(text(p.first) == row.first);
  CHECK(text(p.next) == row.next);
  CHECK(text(p.last) == row.last);
}

TEST_CASE("program: substeps share lists, and their last iteration takes particles to the next") {
  struct Row {
    std::string more;
    std::vector<std::string> set;
    UpdateShape shape;
    std::string update, rest;
  };
  const std::string start = "predict, sort, lists, ", most = "0-1(density+lambda, delta), ",
                    taken = most + "2-2(density+lambda, delta+predict), ",
                    once = "0-0(density+lambda, delta)",
                    once_taken = "0-0(density+lambda, delta+predict), ";
  const Row row = GENERATE_COPY(
      Row{"", {}, {1, 1, 0}, start + kRound, "lists, " + kRound},
      Row{"", {}, {2, 1, 0}, start + kRound + ", predict, " + kRound, "lists, " + taken + kRound},
      Row{"",
          {},
          {3, 1, 0},
          start + kRound + ", predict, " + kRound + ", predict, " + kRound,
          "lists, " + taken + taken + kRound},
      // Positions are predicted already where these lists begin.
      Row{"",
          {},
          {2, 2, 0},
          start + kRound + ", " + start + kRound,
          "lists, " + taken + "sort, lists, " + kRound},
      Row{"",
          {"solver.iterations=1"},
          {5, 2, 0},  // two substeps, then three
          start + once + ", predict, " + once + ", " + start + once + ", predict, " + once +
              ", predict, " + once,
          "lists, " + once_taken + once_taken + "sort, lists, " + once_taken + once_taken + once},
      Row{"",
          {"solver.fused=false", "solver.iterations=2"},
          {2, 1, 0},
          start + "0-1(density, lambda, delta), predict, 0-1(density, lambda, delta)",
          "lists, 0-0(density, lambda, delta), 1-1(density, lambda, delta+predict), 0-1(density, "
          "lambda, delta)"},
      Row{kTank,
          {},
          {2, 1, 0},
          "motion, " + start + kRound + ", motion, predict, " + kRound,
          "lists, " + kRound + ", motion, predict, " + kRound},
      Row{kTank,
          {},
          {2, 2, 0},
          "motion, " + start + kRound + ", motion, " + start + kRound,
          "lists, " + kRound + ", motion, predict+sort, lists, " + kRound},
      // What goes with the lists is made with them, not in every substep.
      Row{kStanding,
          {"solver.iterations=1"},
          {3, 2, 0},
          start + "near solids, " + once + ", " + start + "near solids, " + once + ", predict, " +
              once,
          "lists, near solids, " + once_taken + "sort, lists, near solids, " + once_taken + once},
      Row{"",
          {"solver.iterations=0", "viscosity.xsph=0.1"},
          {3, 2, 0},
          start + start + "predict, xsph",
          "lists, predict+sort, lists, predict"});
  CAPTURE(row.more, row.set, row.shape.substeps, row.shape.lists_per_update);
  const Program p = program_of(row.more, row.set, row.shape);
  CHECK(text(p.rest) == row.rest);
  CHECK(text(p.update) == row.update);
}

TEST_CASE("program: iterations until a tolerance follow those that always run, in every substep") {
  const std::string until = kRound + ", until 4(" + kRound + ")";
  const Program one = program_of("", {}, {1, 1, 4});
  CHECK(text(one.update) == "predict, sort, lists, " + until);
  CHECK(text(one.rest) == "lists, " + until);
  // How many there are is not known before: the last one is not told apart.
  const Program two = program_of("", {}, {2, 2, 4});
  CHECK(text(two.rest) == "lists, " + until + ", predict+sort, lists, " + until);
  const Program shared = program_of("", {}, {2, 1, 4});
  CHECK(text(shared.rest) == "lists, " + until + ", predict, " + until);
  CHECK(text(program_of("", {"solver.iterations=0", "viscosity.xsph=0.1"}, {1, 1, 4}).update) ==
        "predict, sort, lists, xsph");
}

TEST_CASE("program: without pairs particles only move") {
  struct Row {
    std::string more;
    std::vector<std::string> set;
    int substeps;
    std::string update, rest, end;
  };
  const Row row = GENERATE_COPY(
      Row{"", {}, 1, "predict", "predict", ""},
      Row{"", {}, 2, "predict, predict", "predict, predict", ""},
      Row{kTank, {}, 2, "motion, predict, motion, predict", "motion, predict, motion, predict", ""},
      Row{kStanding, {}, 1, "predict", "predict", ""},
      Row{"", {"domain.loads=true"}, 1, "predict, loads", "predict", "loads"},
      Row{kFlow,
          {"domain.loads=true"},
          2,
          "predict, predict, loads, flow",
          "predict, predict",
          "loads, flow"});
  std::vector<std::string> set{"solver.iterations=0"};
  set.insert(set.end(), row.set.begin(), row.set.end());
  CAPTURE(row.more, set);
  const Program p = program_of(row.more, set, {row.substeps, row.substeps, 0});
  CHECK_FALSE(p.has_pairs());
  CHECK(text(p.update) == row.update);
  CHECK(text(p.first) == "");
  CHECK(text(p.rest) == row.rest);
  CHECK(text(p.next) == row.end);
  CHECK(text(p.last) == row.end);
}

TEST_CASE("program: a step without time has lists and iterations alone") {
  const std::vector<std::string> all{"solver.levels=on", "domain.loads=true", "viscosity.xsph=0.1",
                                     "vorticity.epsilon=0.1"};
  const std::string lists = "lists, near solids, level cells, ",
                    round = "0-2(density+lambda, level multipliers, loads of the levels, delta)";
  const Program one = program_of(kTank + kFlow, all, {1, 1, 0}, true);
  CHECK(text(one.update) == "predict, sort, " + lists + round);
  CHECK(text(one.first) == "predict+sort");
  CHECK(text(one.rest) == lists + round);
  CHECK(text(one.next) == "predict+sort");
  CHECK(text(one.last) == "");
  // Nothing moves in between, so delta takes the particles along.
  const Program two = program_of(kTank, {}, {2, 1, 0}, true);
  CHECK(text(two.rest) ==
        "lists, 0-1(density+lambda, delta), 2-2(density+lambda, delta+predict), " + kRound);
  CHECK(text(program_of("", {}, {1, 1, 2}, true).rest) ==
        "lists, " + kRound + ", until 2(" + kRound + ")");
  CHECK(text(program_of("", {"solver.iterations=0", "viscosity.xsph=0.1"}, {}, true).update) ==
        "predict");
}

TEST_CASE("program: passes are independent if neither writes an array that the other one uses") {
  const Program p =
      program_of(kStanding, {"solver.levels=on", "viscosity.xsph=0.1", "vorticity.epsilon=0.1"});
  const auto independent = [&](const std::string& a, const std::string& b) {
    const auto info = [&](const std::string& name) {
      for (const PassInfo& pass : p.passes)
        if (pass.name == name) return pass;
      FAIL("no pass " << name);
      return PassInfo();
    };
    const bool known = are_independent(info(a), info(b));
    CHECK(known == are_independent(info(b), info(a)));
    return known;
  };
  CHECK(independent("lists", "near solids"));
  CHECK(independent("lists", "level cells"));
  CHECK_FALSE(independent("xsph", "curl"));  // curl reads what xsph writes
  CHECK_FALSE(independent("level cells", "level multipliers"));
  CHECK_FALSE(independent("lists", "density+lambda"));  // which uses them
  CHECK_FALSE(independent("lists", "predict"));         // which moves what is listed
  CHECK_FALSE(independent("lists", "lists"));
  CHECK_FALSE(independent("near solids", "sort"));  // which swaps arrays
}

TEST_CASE("program: with packed rows, what xsph gathers is packed before each sweep") {
  const Program p = program_of("", {"viscosity.xsph=0.1"}, {1, 1, 0, true});
  CHECK(text(p.update) == "predict, sort, lists, " + kRound + ", pack motion, xsph");
  CHECK(text(p.next) == "pack motion, xsph+predict+sort");
  CHECK(text(p.last) == "pack motion, xsph");
  const auto gathers = [&](const Program& of, const std::string& name) {
    for (const PassInfo& pass : of.passes)
      if (pass.name == name) return gathers_text(pass);
    return std::string("no such pass");
  };
  CHECK(gathers(p, "density+lambda") == "packed position");
  CHECK(gathers(p, "xsph+predict+sort") == "position");
  CHECK(gathers(program_of("", {"viscosity.xsph=0.1"}), "density+lambda") == "position");
}

TEST_CASE("program: in second order the last correction packs what xsph gathers") {
  const auto packed = [](std::vector<std::string> set, const UpdateShape& shape = {1, 1, 0, true}) {
    set.push_back("time.order=2");
    return program_of("", set, shape);
  };
  const std::string xsph = "viscosity.xsph=0.1", once = "solver.iterations=1";
  const Program p = packed({xsph});
  CHECK(text(p.update) == "predict, sort, lists, " + kRound + ", pack motion, xsph");
  CHECK(text(p.rest) ==
        "lists, 0-1(density+lambda, delta), 2-2(density+lambda, delta+pack motion)");
  CHECK(text(p.next) == "xsph+predict+sort");
  CHECK(text(p.last) == "xsph");
  // Not in the rounds before the last.
  CHECK(text(packed({xsph, once}, {2, 1, 0, true}).rest) ==
        "lists, 0-0(density+lambda, delta+predict), 0-0(density+lambda, delta+pack motion)");
  CHECK(text(packed({xsph, once}, {1, 1, 4, true}).rest) ==
        "lists, 0-0(density+lambda, delta), until 4(0-0(density+lambda, delta)), pack motion");
  // The second sweep gathers the velocities of the first.
  CHECK(text(packed({"viscosity.kinematic=1"}).next).starts_with("xsph, pack motion, xsph"));
  CHECK(text(packed({"viscosity.xsph=0"}).rest) == "lists, " + kRound);
}

TEST_CASE(
    "program: rows are packed where a gather is what limits a pass, and packed ones are right") {
  const auto packs = [](std::int64_t particles, const std::vector<std::string>& more = {},
                        const std::string& yaml = "") {
    std::vector<std::string> set{"backend=cuda"};
    set.insert(set.end(), more.begin(), more.end());
    const Plan plan = make_plan(parse(kMinimal + yaml, set), particles);
    CHECK(plan.shape().packed == plan.packed);
    return plan.packed;
  };
  CHECK(packs(100001));
  CHECK(packs(100001, {"solver.substeps=2", "solver.levels=on", "time.order=1"}));
  CHECK(packs(100001, {}, kStanding));
  CHECK_FALSE(packs(100000));  // several threads share a sum
  for (const char* key :
       {"backend=cpu", "precision=double", "solver.reproducible=true", "solver.fused=false",
        "solver.iterations=0", "solver.kernels=paper",
        // Images are elsewhere than their rows, and emitters move particles in their pipes.
        "domain.periodic=[x]",
        "emitters=[{name: a, shape: disc, center: [0.5, 0.5, 0.5], normal: "
        "[0, 0, -1], radius: 0.2, speed: 1}]"}) {
    CAPTURE(key);
    CHECK_FALSE(packs(100001, {key}));
  }
}

}  // namespace pbf::scene_test
