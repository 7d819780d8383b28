// Every combination of features and shapes of an update: the sequence of passes from an expansion
// of its own, and the joined passes taken apart again.
#include <map>

#include "lib/program/program.h"
#include "tests/support/catch.h"
#include "tests/support/program_steps.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

using test::append;
using test::Sequence;
using test::taken_apart;

/// An update, and the substeps that begin new lists.
struct Division {
  int substeps;
  std::vector<int> new_lists;
};
const std::vector<Division> kDivisions = {{1, {0}},       {2, {0}},    {2, {0, 1}},   {3, {0, 1}},
                                          {3, {0, 1, 2}}, {5, {0, 2}}, {8, {0, 2, 5}}};

/// What a scene has, as bits.
enum Has { moves = 1, loads = 2, xsph = 4, vorticity = 8, levels = 16, flow = 32, all = 64 };

struct Choice {
  int has = 0, iterations = 0, repeats = 0;
  bool fused = true, without_time = false;
  Division division;
  bool is(Has what) const { return (has & what) != 0; }
  bool any(int which) const { return (has & which) != 0; }
};

Scene scene_of(const Choice& c) {
  static const Scene moving = parse(
      kMinimal +
      "tank_motion: {kind: sine, direction: [1, 0, 0], amplitude: 0.1, period: 1}\ngauges: [{name: "
      "q, kind: flow, center: [0.5, 0.5, 0.5], normal: [1, 0, 0], size: [1, 1]}]\n");
  Scene s = moving;
  s.time.order = TimeOrder::first;
  if (!c.is(moves)) s.tank_motion.reset();
  if (!c.is(flow)) s.gauges.clear();
  s.domain.loads = c.is(loads);
  if (c.is(xsph)) s.viscosity.emplace();
  if (c.is(vorticity)) s.vorticity.emplace();
  s.solver.levels = c.is(levels) ? LevelsMode::on : LevelsMode::off;
  s.solver.iterations = c.iterations;
  s.solver.fused = c.fused;
  return s;
}

/// The passes of an update, pass by pass.
Sequence expected_update(const Choice& c) {
  Sequence out;
  const auto iterate = [&] {
    for (int k = 0; k < c.iterations; ++k) {
      const std::string number = " " + std::to_string(k);
      if (c.fused)
        out.push_back("density+lambda" + number);
      else
        out.insert(out.end(), {"density" + number, "lambda" + number});
      if (c.is(levels)) out.push_back("level multipliers" + number);
      if (c.is(levels) && c.is(loads)) out.push_back("loads of the levels" + number);
      out.push_back("delta" + number);
    }
  };
  const bool after = c.any(xsph | vorticity) && !c.without_time;
  const bool pairs = c.iterations > 0 || after;
  for (int s = 0; s < c.division.substeps; ++s) {
    if (c.is(moves) && !c.without_time) out.push_back("motion");
    out.push_back("predict");
    bool lists = false;
    for (const int k : c.division.new_lists) lists = lists || k == s;
    if (pairs && lists) {
      out.insert(out.end(), {"sort", "lists"});
      if (c.is(loads)) out.push_back("near solids");
      if (c.is(levels) && c.iterations > 0) out.push_back("level cells");
    }
    if (c.iterations == 0) continue;
    iterate();
    if (c.repeats == 0) continue;
    out.push_back("until " + std::to_string(c.repeats));
    iterate();
    out.push_back("done");
  }
  if (c.without_time) return out;
  if (c.is(xsph)) out.push_back("xsph");
  if (c.is(vorticity)) out.insert(out.end(), {"curl", "confinement"});
  if (c.is(loads)) out.push_back("loads");
  if (c.is(flow)) out.push_back("flow");
  return out;
}

Sequence of(const Steps& steps) {
  Sequence out;
  append(out, steps);
  return out;
}

/// n updates as they are executed.
Sequence executed(const Program& p, int n) {
  Sequence out = of(p.first);
  append(out, p.rest);
  for (int k = 1; k < n; ++k) append(out, p.next), append(out, p.rest);
  append(out, p.last);
  return out;
}

/// Launches one behind the other that a fused pass could do.
std::string left_apart(const Sequence& launches) {
  for (std::size_t k = 1; k < launches.size(); ++k) {
    const std::string& before = launches[k - 1];
    const std::string name = before.substr(0, before.find_last_not_of("0123456789 ") + 1);
    for (const auto& [both, first, second] : test::kFusedPasses)
      if (name == first && launches[k] == second) return before + ", " + second;
  }
  return {};
}

std::map<std::string, int> counted(const Sequence& launches) {
  std::map<std::string, int> out;
  int times = 1;
  for (const std::string& l : launches) {
    if (l.rfind("until ", 0) == 0)
      out["mean compression"] += times = std::stoi(l.substr(6));
    else if (l == "done")
      times = 1;
    else
      out[l.substr(0, l.find_last_not_of("0123456789 ") + 1)] += times;
  }
  return out;
}
std::map<std::string, int> counted(const std::vector<PassCount>& passes) {
  std::map<std::string, int> out;
  for (const PassCount& c : passes) out[c.pass->name] += c.times;
  return out;
}

/// Calls f(choice, its program) for every choice.
template <class F>
void for_all(const F& f) {
  for (const Division& division : kDivisions)
    for (int has = 0; has < all; ++has)
      for (const int iterations : {0, 1, 2, 5})
        for (const int repeats : {0, 3})
          for (const int more : {0, 1, 2, 3}) {
            const Choice c{has, iterations, repeats, (more & 1) != 0, (more & 2) != 0, division};
            f(c, make_program(scene_of(c),
                              {division.substeps, int(division.new_lists.size()), repeats},
                              c.without_time));
          }
}

std::string described(const Choice& c) {
  return "has " + std::to_string(c.has) + ", iterations " + std::to_string(c.iterations) +
         ", repeats " + std::to_string(c.repeats) + (c.fused ? ", fused" : "") +
         (c.without_time ? ", without time" : "") + ", substeps " +
         std::to_string(c.division.substeps) + ", lists " +
         std::to_string(c.division.new_lists.size());
}

}  // namespace

TEST_CASE("program: an update is the sequence of passes that its features and substeps make") {
  for_all([](const Choice& c, const Program& p) {
    const Sequence got = of(p.update), wanted = expected_update(c);
    if (got == wanted) return;
    CAPTURE(described(c));
    REQUIRE(got == wanted);
  });
}

TEST_CASE("program: joined passes, taken apart, are the updates one behind the other") {
  for_all([](const Choice& c, const Program& p) {
    Sequence wanted;
    for (const int n : {1, 2, 3}) {
      append(wanted, p.update);
      const Sequence got = taken_apart(executed(p, n));
      if (got == wanted) continue;
      CAPTURE(described(c), n);
      REQUIRE(got == wanted);
    }
  });
}

TEST_CASE("program: no two passes stand one behind the other that one pass could do") {
  for_all([](const Choice& c, const Program& p) {
    // delta has taken what the sort behind it would have been joined to.
    for (const Steps* steps : {&p.first, &p.rest, &p.next, &p.last}) {
      const std::string apart = left_apart(of(*steps));
      if (apart.empty()) continue;
      CAPTURE(described(c));
      REQUIRE(apart == "");
    }
  });
}

TEST_CASE("program: the count of passes is that of the launches of an update in the middle") {
  for_all([](const Choice& c, const Program& p) {
    Sequence launches = of(p.next);
    append(launches, p.rest);
    const auto middle = counted(launches), single = counted(of(p.update));
    if (counted(count_passes(p)) == middle && counted(count_passes(p, p.update)) == single) return;
    CAPTURE(described(c));
    REQUIRE(counted(count_passes(p)) == middle);
    REQUIRE(counted(count_passes(p, p.update)) == single);
  });
}

}  // namespace pbf::scene_test
