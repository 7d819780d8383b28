// A feature with a field of the state, which stands in this file alone: temperature, which spreads
// to neighbors. Sort, keep, going back, checkpoint, resume, memory and trace follow from the field.
#include "lib/io/checkpoint.h"
#include "lib/run/emit.h"
#include "lib/scene/load.h"
#include "lib/solver/step_solver.h"
#include "tests/support/catch.h"
#include "tests/support/page_exec.h"
#include "tests/support/run_file_samples.h"
#include "tests/support/scalar_exec.h"

namespace pbf::program_module::field {
/// K
inline constexpr struct Temperature : Numbers {
} temperature{{"temperature", per_padded_row, Life::state, true, Shown{"temperature", "K"}}};
/// Its id, negative. Goes with its particle, but is not saved: it follows from the state.
inline constexpr struct Tag : Plain<int> {
} tag{{"tag", per_particle, Life::rows, true}};
}  // namespace pbf::program_module::field

using namespace pbf;

namespace {

double warm(int id) { return 300 + std::sin(double(id)); }

template <class Lists, class Real>
struct SpreadPass {
  Lists lists;
  int rows;
  GatheredRows<Real> before;
  OwnRows<Real> after;
  OwnRows<const int> tag, id;
  PBF_HD void operator()(int i) const {
    Real sum = 0;
    lists.for_each(i, [&](Neighbor j) {
      if (j.row < rows) sum += before[j] - before[i];  // lists are padded with one that is far
    });
    after[i] = tag[i] == -id[i] ? before[i] + sum / 64 : Real(-1);
  }
};

struct Spread {
  static constexpr PassText text{"spread", "xsph"};
  using Flips = pbf::Flips<field::temperature>;
  using Needs = pbf::Needs<Gathers<other<field::temperature>>, UsesLists, Reads<field::tag>,
                           Reads<field::id>, Writes<field::temperature>>;
  template <class G>
  static void launch(const G& c) {
    c.items(SpreadPass<typename G::Lists, typename G::Real>{
        c.lists(), c.rows(), c[other<field::temperature>], c[field::temperature], c[field::tag],
        c[field::id]});
  }
};

struct TagPass {
  OwnRows<const int> id;
  OwnRows<int> tag;
  PBF_HD void operator()(int i) const { tag[i] = -id[i]; }
};
struct SetTags {
  static constexpr PassText text{"set tags", "xsph"};
  using Needs = pbf::Needs<Reads<field::id>, Writes<field::tag>>;
};

struct Heat {
  using Passes = PassList<Spread>;
  static void add(const Scene&, auto& b) { b.after(Spread()); }
  template <class Real>
  struct Memory : NoMemory {
    template <class C>
    void make(C& c) {
      std::vector<Real> all;
      for (int id = 0; id < c.rows(); ++id) all.push_back(Real(warm(id)));
      c.put(field::temperature, all);
    }
    template <class C>
    void forget(C& c) {
      c.template as_pass<SetTags>([](const auto& pass) {
        pass.items(TagPass{pass[field::id], pass[field::tag]});
      });
    }
  };
};
using MoreFeatures = Features::With<Heat>;

struct Warm {
  Scene scene;
  Plan plan;
  explicit Warm(std::vector<std::string> set) {
    set.insert(set.end(), {"fluid.spacing=0.04", "time.adaptive=off"});
    scene = load_scene(PBF_SOURCE_DIR "/configs/minimal.yaml", set).scene;
    plan = make_plan(scene, std::int64_t(particles().size()));
    plan.program = make_program_of<MoreFeatures>(scene, plan.shape());
    plan.memory = plan_memory(scene, plan);
  }
  Particles particles() const { return emit_particles(scene, ""); }
  template <class Real>
  std::unique_ptr<Solver> solver(int threads = 1) const {
    return std::make_unique<StepSolver<Real, ScalarExec, MoreFeatures>>(scene, plan, particles(),
                                                                        threads);
  }
};

const std::vector<double>& temperatures(const SolverState& s) {
  REQUIRE(s.find("temperature"));
  return s.find("temperature")->values;
}
double spread(const std::vector<double>& all) {
  const auto [low, high] = std::minmax_element(all.begin(), all.end());
  return *high - *low;
}
bool same(const SolverState& a, const SolverState& b) {
  return a.position == b.position && a.velocity == b.velocity && a.fields == b.fields;
}

}  // namespace

TEST_CASE("a further field of the state begins as its feature says, and goes with its particle") {
  const Warm warmed({"precision=double"});
  const auto s = warmed.solver<double>();
  const SolverState first = s->state();
  for (std::size_t k = 0; k < first.id.size(); ++k)
    REQUIRE(temperatures(first)[k] == warm(first.id[k]));
  s->step(40);
  const SolverState later = s->state();
  CHECK(later.position != first.position);
  CHECK(spread(temperatures(later)) < 0.9 * spread(temperatures(first)));
  // The mean is kept but for rounding, because pairs exchange; -1 would mark a row that lost its
  // tag.
  double sum = 0;
  for (const double t : temperatures(later)) {
    REQUIRE(t > 298);
    sum += t - 300;
  }
  for (const double t : temperatures(first)) sum -= t - 300;
  CHECK(std::abs(sum) < 1e-8);
}

TEST_CASE("a further field of the state is kept, goes back, and does not depend on threads") {
  const Warm warmed({"precision=float", "solver.substeps=2"});
  const auto s = warmed.solver<float>(1), two = warmed.solver<float>(3);
  s->step(10);
  two->step(10);
  CHECK(same(s->state(), two->state()));
  s->keep();
  const SolverState kept = s->state(StateOf::kept);
  s->step(5);
  const SolverState later = s->state();
  CHECK(temperatures(later) != temperatures(kept));
  CHECK(same(s->state(StateOf::kept), kept));
  s->set_state(kept);
  CHECK(same(s->state(), kept));
  s->inspection()->trace({});
  s->step(4);
  CHECK(same(s->state(), later));
}

TEMPLATE_TEST_CASE("a further field of the state is in a checkpoint, from which a run resumes", "",
                   float, double) {
  const Warm warmed({"precision=" + std::string(word(precision_of<TestType>)), "viscosity={}"});
  const auto s = warmed.solver<TestType>();
  s->step(7);
  test::TemporaryFolder folder;
  SavedRun run;
  run.state = s->state();
  run.particles = std::int64_t(run.state.id.size());
  write_checkpoint(folder.path, run);
  std::vector<std::string> notes;
  const auto read = read_checkpoint(folder.path, notes);
  REQUIRE(read);
  CHECK(temperatures(read->state) == temperatures(run.state));
  const auto resumed = warmed.solver<TestType>();
  resumed->set_state(read->state);
  s->step(9);
  resumed->step(9);
  CHECK(same(s->state(), resumed->state()));
}

TEST_CASE(
    "values of a state: zeros for rows of another scene, an error for another number of "
    "particles") {
  const std::size_t numbers = 12;
  SolverState s;
  s.fields = {{"loads", false, 8, std::vector<double>(2 * 8, 1.5)},
              {"temperature", true, 1, {1, 2}}};
  const std::vector<double> loads = values_of(s, field::loads, 2);  // an older file
  REQUIRE(loads.size() == 2 * numbers);
  CHECK(loads[7] == 1.5);
  CHECK(loads[8] == 0);
  CHECK(loads[16] == 1.5);
  CHECK(values_of(s, field::loads, 3) == std::vector<double>(3 * numbers));
  CHECK(values_of(s, field::flows, 2) == std::vector<double>(6));
  CHECK(values_of(s, field::temperature, 2) == std::vector<double>{1, 2});
  CHECK_THROWS_AS(values_of(s, field::temperature, 3), Error);
  s.fields[0] = {"loads", false, 13, std::vector<double>(26)};
  CHECK_THROWS_AS(values_of(s, field::loads, 2), Error);
}

TEST_CASE("numbers of a file that an integer cannot hold become the nearest that it can") {
  CHECK(from_number<unsigned long long>(-1) == 0);
  CHECK(from_number<unsigned long long>(1e30) == std::numeric_limits<unsigned long long>::max());
  CHECK(from_number<int>(std::nan("")) == 0);
  CHECK(from_number<std::int64_t>(-1e30) == std::numeric_limits<std::int64_t>::min());
  CHECK(from_number<int>(-7) == -7);
}

TEST_CASE("a further field is in the plan, in the memory of the solver, and in a trace") {
  const Warm warmed({"precision=float", "guard={}"});
  const auto s = warmed.solver<float>();
  s->keep();
  s->diagnose();
  std::size_t arrays = 0;
  for (const PlanArray& a : warmed.plan.memory.arrays)
    arrays += a.name == "temperature" || a.name == "temperature'" || a.name == "kept temperature";
  CHECK(arrays == 3);
  bool shown = false;
  for (const TraceArray& a : s->inspection()->trace({}).arrays)
    shown = shown || a.quantity == "temperature";
  CHECK(shown);
}

TEST_CASE("the passes of a further feature, and the sorts, touch what they declare") {
  const Warm warmed({"precision=float", "output=off"});
  Touches touches;
  StepSolver<float, PageExec, MoreFeatures> s(warmed.scene, warmed.plan, warmed.particles(),
                                              touches, warmed.plan);
  s.step(3, {});
  s.trace({});
  for (const auto& [pass, fields] : touches)
    for (const auto& [name, touch] : fields) {
      CAPTURE(pass, name);
      CHECK_FALSE((touch.read && !(touch.declared & kReading)));
      CHECK_FALSE((touch.written && !(touch.declared & kWriting)));
    }
  CHECK(touches["predict+sort"]["temperature"].written);
  CHECK(touches["predict+sort"]["tag'"].read);
  CHECK(touches["set tags"]["tag"].written);  // launched by a hook
}
