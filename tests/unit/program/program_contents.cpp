// What a program says of itself beside its passes: what is left out, counts, arrays, joined passes.
#include <algorithm>
#include <set>

#include "lib/program/features.h"
#include "lib/program/program.h"
#include "tests/support/catch.h"
#include "tests/support/program_steps.h"

namespace pbf::scene_test {
namespace {

bool has_field(const Program& p, const std::string& name) {
  return std::any_of(p.fields.begin(), p.fields.end(),
                     [&](const FieldInfo* f) { return f->name == name; });
}

using Count = std::pair<std::string, int>;
std::vector<Count> counts_of(const std::vector<PassCount>& passes) {
  std::vector<Count> out;
  for (const PassCount& c : passes) out.emplace_back(c.pass->name, c.times);
  return out;
}

}  // namespace

TEST_CASE("program: what a scene does without is named with the reason, in the features' order") {
  using Lines = std::vector<std::string>;
  const auto left_out = [](const std::string& more, const std::vector<std::string>& set) {
    Lines lines;
    for (const LeftOut& l : program_of(more, set).left_out)
      lines.push_back(l.what + ": " + l.because);
    return lines;
  };
  const std::string obstacles = "motion of obstacles: no obstacle has motion",
                    tank = "motion of the tank: no key tank_motion",
                    free = "free bodies: no obstacle is free",
                    order = "velocities without the last push: time.order is 1",
                    calm = "passes of hyperviscosity, its array: time.order is 1",
                    iterations = "lambda and delta passes: solver.iterations is 0",
                    density = "density pass of its own: solver.fused is true",
                    levels = "levels: grids coarser than h: solver.levels is off",
                    pressure = "artificial pressure in the delta loop: no key tensile",
                    rows = "particles that come and go: no keys emitters, sinks",
                    xsph = "xsph pass: no key viscosity",
                    slip = "friction pass: friction is 0 on all walls and obstacles",
                    curl = "curl and confinement passes, curl array: no key vorticity",
                    sponges = "sponge pass: no key damping",
                    loads =
                        "loads on the walls: domain.loads is false, and no obstacle has loads "
                        "or motion",
                    gauges = "gauges: no key gauges";
  CHECK(left_out("", {}) == Lines{tank, density, levels, pressure, rows, xsph, slip, curl, sponges,
                                  loads, gauges, order, calm});
  CHECK(left_out("", {"solver.fused=false"}) ==
        Lines{tank, levels, pressure, rows, xsph, slip, curl, sponges, loads, gauges, order, calm});
  CHECK(left_out("", {"solver.iterations=0"}) ==
        Lines{tank, iterations, "levels: grids coarser than h: solver.iterations is 0", rows, xsph,
              slip, curl, sponges, loads, gauges, order,
              "passes of hyperviscosity, its array: solver.iterations is 0"});
  CHECK(left_out("", {"viscosity.xsph=0", "vorticity.epsilon=0", "tensile.k=0"}) ==
        Lines{tank, density, levels, pressure, rows, xsph, slip, curl, sponges, loads, gauges,
              order, calm});
  CHECK(left_out(kStanding, {"viscosity.xsph=0.1"}) == Lines{obstacles, tank, free, density, levels,
                                                             pressure, rows, slip, curl, sponges,
                                                             loads, gauges, order, calm});
  CHECK(left_out(kWaveMaker, {"vorticity.epsilon=0.1"}) == Lines{tank, free, density, levels,
                                                                 pressure, rows, xsph, slip,
                                                                 sponges, gauges, order, calm});
  CHECK(left_out(kTank + kLevelGauge,
                 {"solver.levels=on", "tensile.k=0.01", "solver.fused=false", "viscosity.xsph=0.1",
                  "vorticity.epsilon=0.1", "domain.loads=true"}) ==
        Lines{rows, slip, sponges, order, calm});
}

TEST_CASE("program: passes are counted as often as they run at most, with what tests a tolerance") {
  CHECK(counts_of(count_passes(program_of("", {}))) ==
        std::vector<Count>{{"predict+sort", 1}, {"lists", 1}, {"density+lambda", 3}, {"delta", 3}});
  CHECK(counts_of(count_passes(program_of("", {"viscosity.xsph=0.1"}, {2, 1, 0}))) ==
        std::vector<Count>{{"xsph+predict+sort", 1},
                           {"lists", 1},
                           {"density+lambda", 6},
                           {"delta", 5},
                           {"delta+predict", 1}});
  const Program p = program_of("", {}, {2, 2, 4});
  CHECK(counts_of(count_passes(p, p.update)) == std::vector<Count>{{"predict", 2},
                                                                   {"sort", 2},
                                                                   {"lists", 2},
                                                                   {"density+lambda", 30},
                                                                   {"delta", 30},
                                                                   {"mean compression", 8}});
}

TEST_CASE("program: the arrays are those of its passes, each once, and those of every solver") {
  struct Row {
    const char* field;
    std::string more;
    std::vector<std::string> set;
  };
  const std::set<std::string> always{"position", "velocity", "density", "id",
                                     "counts",   "bin",      "order",   "bin_start"};
  for (const char* iterations : {"solver.iterations=0", "solver.iterations=3"}) {
    std::set<std::string> names;
    const Program p = program_of("", {iterations});
    for (const FieldInfo* f : p.fields) CHECK(names.insert(f->name).second);
    CHECK(names == always);
  }
  for (const Row& row :
       {Row{"curl", "", {"vorticity.epsilon=0.1"}}, Row{"near rows", kStanding, {}},
        Row{"near rows", "", {"domain.loads=true"}},
        // A measure makes lists in any case, and what goes with them.
        Row{"near rows", kStanding, {"solver.iterations=0"}},
        Row{"load sums", "", {"domain.loads=true"}},
        Row{"load sums", "", {"domain.loads=true", "solver.iterations=0"}},
        Row{"flow sides", kFlow, {}}, Row{"level home", "", {"solver.levels=on"}},
        Row{"free velocity", "", {"time.order=2"}}, Row{"velocity laplacian", "", {"time.order=2"}},
        Row{"wall pushes", "", {"time.order=2", "domain.loads=true"}},
        Row{"obstacle friction", kStanding, {"viscosity.kinematic=1e-4", "obstacles.0.friction=1"}},
        Row{"level multiplier", "", {"solver.levels=on"}}}) {
    CAPTURE(row.field, row.set);
    CHECK(has_field(program_of(row.more, row.set), row.field));
    CHECK_FALSE(has_field(program_of("", {}), row.field));
  }
}

TEST_CASE("program: the fused passes are those of the table, and names tell all passes apart") {
  std::set<std::string> names;
  for (const PassText& pass : pass_texts()) CHECK(names.insert(pass.name).second);
  std::set<std::string> found, expected;
  for (const auto& [both, first, second] : test::kFusedPasses)
    expected.insert(both + " = " + first + " + " + second);
  for (int a = 0; a < Passes::size; ++a)
    for (int b = 0; b < Passes::size; ++b)
      if (const int both = Passes::fused(a, b); both >= 0) {
        const auto name = [](int k) { return std::string(pass_texts()[std::size_t(k)].name); };
        found.insert(name(both) + " = " + name(a) + " + " + name(b));
      }
  CHECK(found == expected);
}

}  // namespace pbf::scene_test
