// What passes declare of the arrays (lib/program/needs.h) is what they do with them: all passes of
// all features run in scenes on an executor that sees every touch.
#include <filesystem>

#include "lib/run/emit.h"
#include "lib/run/motion_files.h"
#include "lib/scene/load.h"
#include "lib/solver/step_solver.h"
#include "tests/support/catch.h"
#include "tests/support/page_exec.h"

using namespace pbf;

namespace {

struct Scenario {
  const char* scene;
  std::vector<std::string> set;
  double fast = 0;  ///< m/s, of every other particle along x
};
const std::vector<Scenario> kScenarios = {
    {"configs/minimal", {"fluid.spacing=0.05"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.fused=false", "tensile={}"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.kernels=paper", "vorticity.epsilon=1"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.substeps=3", "solver.iterations=1"}, 20},
    {"configs/minimal", {"fluid.spacing=0.05", "viscosity.xsph=0.1", "solver.tolerance=1e-4"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.fused=false"}, 20},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.iterations=0"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.iterations=0", "viscosity.xsph=0.1"}},
    {"configs/extreme/points", {"bodies[0].path=one_place.csv"}},
    {"configs/extreme/points",
     {"bodies[0].path=one_place.csv", "solver.substeps=2", "solver.iterations=1"}},
    {"configs/dam_break_2d", {"fluid.spacing=0.02", "vorticity.epsilon=1"}},
    {"configs/dam_break_2d", {"fluid.spacing=0.02", "solver.levels=on", "domain.open=[x_max]"}},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "solver.levels=on", "solver.iterations=2", "domain.loads=true"}},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "solver.levels=on", "solver.iterations=1", "solver.substeps=2",
      R"(obstacles=[{"name":"a","shape":"box","min":[0.05,0.05,0.5],"max":[0.1,0.1,0.6]}])"}},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "solver.iterations=1", "solver.substeps=2",
      R"(gauges=[{"name":"p","kind":"pressure","on":"z_min","at":[0.05,0.05,0],"radius":0.05},)"
      R"({"name":"v","kind":"velocity","at":[0.05,0.05,0.5]}])"},
     60},
    {"tests/regression/frozen/obstacles", {}},
    {"tests/regression/frozen/obstacles", {"solver.fused=false", "domain.loads=false"}},
    {"tests/regression/frozen/obstacles",
     {"solver.substeps=3", "solver.iterations=1", "viscosity.xsph=0.1"}},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "viscosity.xsph=0.1",
      R"(obstacles=[{"name":"a","shape":"box","min":[0.05,0.05,0.5],"max":[0.1,0.1,0.6]}])"},
     60},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "viscosity.xsph=0.1",
      R"(obstacles=[{"name":"a","shape":"box","min":[0.05,0.05,0.5],"max":[0.1,0.1,0.6]}])"}},
    {"tests/regression/frozen/motions", {}},
    {"tests/regression/frozen/motions", {}, 60},
    {"tests/regression/frozen/motions", {"solver.substeps=3", "viscosity.xsph=0.1"}, 20},
    {"tests/regression/frozen/obstacles_2d", {"solver.kernels=paper"}},
};

/// Adds what the passes of a scene touched and what they declared.
struct Seen {
  Touches touches;
  std::map<std::string, std::map<std::string, unsigned>> declared;
};
void run(const Scenario& of, Seen& seen) {
  const std::string file = std::string(PBF_SOURCE_DIR) + "/" + of.scene + ".yaml";
  std::vector<std::string> set = of.set;
  set.insert(set.end(), {"precision=float", "output=off", "render=off"});
  Scene scene = load_scene(file, set).scene;
  read_motions(scene, std::filesystem::path(file).parent_path().string());
  Particles particles = emit_particles(scene, std::filesystem::path(file).parent_path().string());
  for (std::size_t k = 0; k < particles.size(); k += 2) particles.velocity[k][0] += of.fast;
  const Plan plan = make_plan(scene, std::int64_t(particles.size()));
  StepSolver<float, PageExec> solver(scene, plan, std::move(particles), seen.touches);
  solver.measure();
  StepOptions watched;
  if (of.fast > 0) watched.watched_speed = of.fast / 2;
  solver.step(3, watched);  // passes joined
  solver.trace({});         // pass by pass
  solver.readings(Series::gauges, Interval::goes_on);
  StepOptions relieve;
  relieve.without_time = 0.5;
  solver.step(1, relieve);
  solver.measure();
  for (const PassInfo& p : plan.program.passes)
    for (const AccessInfo& a : p.needs)
      if (a.field->rows && seen.touches.contains(p.name))
        seen.declared[p.name][name_of(*a.field)] |= a.how;
}

}  // namespace

TEST_CASE("passes touch what they declare, as they declare it, and declare nothing else",
          "[slow]") {
  Seen all;
  for (const Scenario& of : kScenarios) {
    Seen seen;
    run(of, seen);
    CAPTURE(of.scene, of.set);
    for (const auto& [pass, fields] : seen.touches) {
      all.touches[pass];
      for (const auto& [field, touch] : fields) {
        CAPTURE(pass, field);
        const unsigned how = seen.declared[pass][field];
        CHECK_FALSE((touch.read && !(how & kReading)));
        CHECK_FALSE((touch.written && !(how & kWriting)));
        Touch& sum = all.touches[pass][field];
        sum.read |= touch.read, sum.written |= touch.written;
      }
    }
    for (const auto& [pass, fields] : seen.declared)
      for (const auto& [field, how] : fields) all.declared[pass][field] |= how;
  }
  // Every declaration is needed in one scene at least.
  for (const auto& [pass, fields] : all.declared)
    for (const auto& [field, how] : fields) {
      if (field == field::order.name) continue;  // this executor has it in the ids
      CAPTURE(pass, field);
      const Touch touch = all.touches[pass][field];
      CHECK((touch.read || !(how & kReading)));
      CHECK((touch.written || !(how & kWriting)));
    }
  for (const PassText& pass : pass_texts()) {
    CAPTURE(pass.name);
    CHECK(all.touches.contains(pass.name));  // each pass has run
  }
}

namespace {

/// A pass with declarations, and what the compiler lets it have.
struct Sample {
  using Needs = pbf::Needs<Gathers<field::position>, Reads<field::velocity>, Writes<field::density>,
                           Adds<field::load_sums>>;
};
using Samples = Granted<StepContext<float, CpuExec, Features>, Sample>;
template <class Field>
using Handle = decltype(std::declval<const Samples&>()[std::declval<const Field&>()]);
template <class Field>
concept Granting = requires(const Samples& c, const Field& f) {
  c[f];
};
template <class T>
concept ReadsNeighbors = requires(T rows) {
  rows[Neighbor{3}];
};
template <class T, class Row>
concept Writable = requires(T rows, Row row) {
  rows[0] = row;
};
template <class G>
concept HasLists = requires(const G& c) {
  c.lists();
};
template <class T>
concept Readable = requires(T rows) {
  rows[0];
};

static_assert(Granting<field::Position> && !Granting<field::Id> && !Granting<field::Bin>);
static_assert(!Granting<Other<field::position>>);  // the second array is a field of its own
static_assert(ReadsNeighbors<Handle<field::Position>> && !ReadsNeighbors<Handle<field::Velocity>>);
static_assert(!ReadsNeighbors<Handle<field::Density>>);
static_assert(Readable<Handle<field::Velocity>> && !Writable<Handle<field::Velocity>, Vec4<float>>);
static_assert(!Writable<Handle<field::Position>, Vec4<float>>);
static_assert(Writable<Handle<field::Density>, float>);
static_assert(!Readable<Handle<field::LoadRows>>);  // nobody reads sums that grow
static_assert(!HasLists<Samples>);

}  // namespace
