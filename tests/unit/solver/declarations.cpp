// What passes declare of the arrays (lib/program/needs.h) is what they do with them: all passes of
// all features run in scenes on an executor that sees every touch.
#include <filesystem>

#include "lib/exec/make_solver.h"
#include "lib/run/emit.h"
#include "lib/run/linked_files.h"
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
constexpr const char* kFreeBox =
    R"(obstacles=[{"name":"a","shape":"box","min":[0.03,0.03,0.5],"max":[0.08,0.08,0.6],)"
    R"("free":{"density":300}}])";
const std::string kEverywhere =
    R"(damping=[{"name":"a","min":[-9,-9,-9],"max":[9,9,9],"toward":"x_max","rate":3}])";
const std::vector<Scenario> kScenarios = {
    {"configs/minimal", {"fluid.spacing=0.05"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.fused=false", "tensile={}"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.kernels=paper", "vorticity.epsilon=1"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.substeps=3", "solver.iterations=1"}, 20},
    {"configs/minimal", {"fluid.spacing=0.05", "viscosity.xsph=0.1", "solver.tolerance=1e-4"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.fused=false"}, 20},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.iterations=0"}},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.iterations=0", "viscosity.xsph=0.1"}, 0.1},
    {"configs/minimal", {"fluid.spacing=0.05", "solver.velocity_damping=0.9"}},
    {"configs/minimal",
     {"fluid.spacing=0.05", "solver.velocity_damping=0.9", "solver.substeps=3",
      "viscosity.xsph=0.1"},
     0.1},
    {"configs/minimal", {"fluid.spacing=0.05", kEverywhere}},
    {"configs/minimal", {"fluid.spacing=0.05", kEverywhere, "time.order=1"}},
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
     {"fluid.spacing=0.025", "solver.iterations=1", "solver.substeps=2", "time.order=1",
      R"(gauges=[{"name":"p","kind":"pressure","on":"z_min","at":[0.05,0.05,0],"radius":0.05},)"
      R"({"name":"v","kind":"velocity","at":[0.05,0.05,0.5]}])"},
     60},
    {"tests/regression/frozen/obstacles", {"time.order=1"}},
    {"tests/regression/frozen/obstacles", {"solver.fused=false", "domain.loads=false"}},
    {"tests/regression/frozen/obstacles",
     {"solver.substeps=3", "solver.iterations=1", "viscosity.xsph=0.1", "time.order=1"}},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "viscosity.xsph=0.1",
      R"(obstacles=[{"name":"a","shape":"box","min":[0.05,0.05,0.5],"max":[0.1,0.1,0.6]}])"},
     60},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "viscosity.xsph=0.1",
      R"(obstacles=[{"name":"a","shape":"box","min":[0.05,0.05,0.5],"max":[0.1,0.1,0.6]}])"}},
    {"tests/regression/frozen/motions", {"time.order=1"}},
    {"tests/regression/frozen/motions", {"time.order=1"}, 60},
    {"tests/regression/frozen/motions",
     {"time.order=1", "solver.substeps=3", "viscosity.xsph=0.1"},
     20},
    {"tests/regression/frozen/motions", {"tank_motion=off"}},
    {"tests/regression/frozen/bodies", {}},
    {"configs/stiff/column", {"fluid.spacing=0.025", kFreeBox}, 60},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "solver.substeps=2", "solver.iterations=1", kFreeBox},
     60},
    {"configs/stiff/column",
     {"fluid.spacing=0.025", "solver.substeps=2", "solver.iterations=1", "time.order=1", kFreeBox},
     60},
    {"tests/regression/frozen/bodies",
     {"time.order=1", "solver.substeps=3", "solver.iterations=1"}},
    {"configs/minimal", {"fluid.spacing=0.05", "time.order=2"}},
    {"configs/minimal", {"fluid.spacing=0.05", "time.order=2", "time.step=0.05"}},
    {"configs/minimal",
     {"fluid.spacing=0.05", "time.order=2", "solver.substeps=3", "vorticity.epsilon=1"}},
    {"configs/minimal", {"fluid.spacing=0.05", "time.order=2", "solver.fused=false"}, 20},
    {"configs/dam_break_2d",
     {"fluid.spacing=0.02", "time.order=2", "solver.levels=on", "domain.loads=true",
      "viscosity.xsph=0.1"}},
    {"configs/minimal",
     {"fluid.spacing=0.05", "time.order=2", "time.adaptive={}", "domain.loads=true"}},
    {"tests/regression/frozen/obstacles", {"time.order=2"}},
    {"tests/regression/frozen/motions", {"time.order=2"}, 60},
    {"tests/regression/frozen/motions",
     {"time.order=2", "solver.substeps=3", "viscosity.xsph=0.1"},
     20},
    {"configs/sloshing_tank", {"fluid.spacing=0.04"}},
    {"tests/regression/frozen/obstacles_2d", {"solver.kernels=paper"}},
    {"tests/regression/frozen/meshes", {}, 60},
    {"tests/regression/frozen/meshes",
     {"time.order=1", "tank_motion=off", "solver.fused=false", "domain.loads=false",
      "obstacles.0.motion=off"}},
    {"configs/minimal",
     {"fluid.spacing=0.05", "viscosity.kinematic=0.01", "domain.friction=1"},
     0.1},
    {"configs/minimal",
     {"fluid.spacing=0.05", "viscosity.kinematic=0.5", "domain.friction=0.5",
      "domain.friction_on=[z_min]", "domain.loads=true", "time.order=1"},
     0.1},
    {"configs/dam_break_2d",
     {"fluid.spacing=0.02", "viscosity={\"kinematic\":0.001}", "domain.friction=1"}},
    {"tests/regression/frozen/obstacles", {"viscosity.xsph=0.1", "obstacles.0.friction=1"}, 0.1},
    {"tests/regression/frozen/motions",
     {"viscosity.xsph=0.1", "obstacles.0.friction=1", "obstacles.1.friction=1"},
     20},
    {"tests/regression/frozen/meshes",
     {"viscosity.kinematic=0.01", "obstacles.0.friction=1", "obstacles.1.friction=0.5"},
     60},
    {"tests/regression/frozen/emitters", {}},
    {"tests/regression/frozen/emitters",
     {"time.order=1", "obstacles=[]", "solver.substeps=3", "viscosity.xsph=0.1"}},
    {"tests/regression/frozen/emitters",
     {"bodies.0.velocity=[0, 0, 8]", "time.step=0.004",
      R"(emitters=[{"name":"a","shape":"disc","center":[0.3,0.3,0.4],"normal":[0,0,-1],)"
      R"("radius":0.08,"speed":1}])"}},
    {"tests/regression/frozen/emitters", {"emitters=[]", "gauges=[]"}},
};

struct Prepared {
  Scene scene;
  Plan plan;
  Particles particles;
  Touches touches{};
  explicit Prepared(const Scenario& of) {
    const std::string file = std::string(PBF_SOURCE_DIR) + "/" + of.scene + ".yaml";
    const std::string folder = std::filesystem::path(file).parent_path().string();
    std::vector<std::string> set = of.set;
    set.insert(set.end(), {"precision=float", "output=off", "render=off", "threads=1"});
    scene = load_scene(file, set).scene;
    read_linked_files(scene, folder);
    particles = emit_particles(scene, folder);
    for (std::size_t k = 0; k < particles.size(); k += 2) particles.velocity[k][0] += of.fast;
    plan = make_plan(scene, std::int64_t(particles.size()));
    plan.program = make_program_of<Features>(scene, plan.shape());
  }
  /// A solver that sees what passes touch, and forgets what no declaration promises.
  std::unique_ptr<Solver> watched(const std::string& forgets = "") {
    return std::make_unique<StepSolver<float, PageExec>>(scene, plan, particles, touches, plan,
                                                         forgets);
  }
};

StepOptions watching(const Scenario& of) {
  StepOptions options;
  if (of.fast > 0) options.watched_speed = of.fast / 2;
  return options;
}
StepOptions without_time() {
  StepOptions options;
  options.without_time = 0.5;
  return options;
}

/// What the passes of a scene touched and what they declared.
Touches run(const Scenario& of) {
  Prepared made(of);
  const auto solver = made.watched();
  solver->diagnose();
  // Passes joined. Until particles have come and gone.
  solver->step(comes_and_goes(made.scene) ? 40 : 3, watching(of));
  if (made.scene.time.adaptive) solver->step(1, {.level = 1});
  if (!changes_rows(made.scene)) solver->inspection()->trace({});  // pass by pass
  solver->readings(Series::gauges, Interval::goes_on);
  solver->step(1, without_time());
  solver->diagnose();
  return made.touches;
}

/// What a user sees of a solver: state, loads, gauges and diagnostics.
struct Results {
  SolverState state;
  std::vector<double> numbers;
  bool operator==(const Results& o) const {
    // A number may be undefined in both.
    const auto same = [](double a, double b) { return a == b || (a != a && b != b); };
    return state.position == o.state.position && state.velocity == o.state.velocity &&
           state.fields == o.state.fields &&
           std::equal(numbers.begin(), numbers.end(), o.numbers.begin(), o.numbers.end(), same);
  }
};
Results results(Solver& s) {
  Results r{s.state(), s.readings(Series::gauges, Interval::goes_on)};
  for (const double load : s.readings(Series::measures, Interval::goes_on))
    r.numbers.push_back(load);
  const Diagnostics m = s.diagnose();
  for (const auto& d : diagnostics()) r.numbers.push_back(d.value(m));
  return r;
}

/// After which work the results differ from those of a solver that forgets nothing; empty: never.
std::string first_difference(const Scenario& of, const std::string& forgets) {
  Prepared made(of);
  const auto right = make_solver(made.scene, made.plan, made.particles),
             watched = made.watched(forgets);
  std::string first;
  const auto both = [&](const char* after, const auto& work) {
    if (!first.empty()) return;
    work(*right), work(*watched);
    if (!(results(*right) == results(*watched))) first = after;
  };
  both("start", [](Solver&) {});
  for (const int updates : {1, 1, 3, 2})
    both("updates", [&](Solver& s) { s.step(updates, watching(of)); });
  if (!changes_rows(made.scene)) both("trace", [](Solver& s) { s.inspection()->trace({}); });
  both("update after a trace", [](Solver& s) { s.step(1); });
  both("keep", [](Solver& s) { s.keep(), s.step(2, without_time()); });
  both("back", [](Solver& s) { s.set_state(s.state(StateOf::kept)), s.step(2); });
  return first;
}

}  // namespace

/// Fields that a pass may touch for some particles alone: fast ones, those at the same place, those
/// near walls, solids or gauges, those that lose energy.
bool for_some(const std::string& field) {
  static const std::set<std::string> all = {
      "body shares", "clamp sums", "counts",  "dissipation", "id",          "load sums",
      "near count",  "near rows",  "patches", "sharers",     "solid scene", "velocity"};
  return all.contains(field);
}

TEST_CASE("passes touch what they declare, as they declare it, and declare nothing else",
          "[slow]") {
  Touches all;
  for (const Scenario& of : kScenarios) {
    CAPTURE(of.scene, of.set);
    std::set<std::string> unused;  // by all passes of the scene; fields that If<> is to leave out
    const Touches seen = run(of);
    for (const auto& [pass, fields] : seen)
      for (const auto& [field, touch] : fields) unused.insert(field);
    for (const auto& [pass, fields] : seen)
      for (const auto& [field, touch] : fields) {
        CAPTURE(pass, field);
        const bool touched = touch.read || touch.written;
        if (touched) unused.erase(field);
        if (field == field::row_state.name && !touch.declared) continue;  // the host reads it
        CHECK_FALSE((touch.read && !(touch.declared & kReading)));
        CHECK_FALSE((touch.written && !(touch.declared & kWriting)));
        CHECK((touched || for_some(field) || field == field::order.name));
        Touch& sum = all[pass][field];
        sum.read |= touch.read, sum.written |= touch.written, sum.declared |= touch.declared;
      }
    // This executor has the order in the ids, and no particle may be fast or hit a patch.
    for (const char* maybe : {field::order.name, field::counts.name, field::patches.name})
      unused.erase(maybe);
    CHECK(unused == std::set<std::string>{});
  }
  // Every declaration is needed in one scene at least.
  for (const auto& [pass, fields] : all)
    for (const auto& [field, touch] : fields) {
      if (field == field::order.name) continue;
      CAPTURE(pass, field);
      CHECK((touch.read || !(touch.declared & kReading)));
      CHECK((touch.written || !(touch.declared & kWriting)));
    }
  for (const PassText& pass : pass_texts()) {
    CAPTURE(pass.name);
    if (std::string(pass.name).ends_with(PackMotion::text.name)) continue;  // of GPUs alone
    CHECK(all.contains(pass.name));                                         // each pass has run
  }
}

TEST_CASE(
    "results stay when all is nonsense that no declaration promises: fields of passes after an "
    "update, what a pass replaces, second arrays, undeclared fourth numbers, new memory",
    "[slow]") {
  for (const Scenario& of : kScenarios) {
    const std::string after = first_difference(of, "");
    std::string because_of;
    if (!after.empty() && !first_difference(of, "no field").empty())
      because_of = "new memory, or another mistake";
    else if (!after.empty())
      for (const FieldInfo* f : Prepared(of).plan.program.fields)
        if (!first_difference(of, f->name).empty()) because_of += std::string(f->name) + " ";
    CAPTURE(of.scene, of.set, after, because_of);
    CHECK(after.empty());
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
