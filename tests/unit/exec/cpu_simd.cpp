// The CPU backend with every set of vector instructions against one particle at a time: the same
// bits from every pass.
#include <cstdlib>
#include <optional>

#include "kernels/lanes.h"
#include "lib/base/error.h"
#include "lib/program/simd.h"
#include "tests/support/catch.h"
#include "tests/support/states.h"

namespace {

using namespace pbf;
using oracle_test::Case;
using oracle_test::flat_block;
using oracle_test::jittered_block;

/// The environment variable for the length of a scope.
class ForcedSimd {
 public:
  explicit ForcedSimd(const std::string& name) {
    if (const char* old = std::getenv("PBF_SIMD")) old_ = old;
    setenv("PBF_SIMD", name.c_str(), 1);
  }
  ~ForcedSimd() { old_ ? setenv("PBF_SIMD", old_->c_str(), 1) : unsetenv("PBF_SIMD"); }

 private:
  std::optional<std::string> old_;
};

/// What one update leaves behind pass by pass, after a few others; then the state some updates on.
struct Outcome {
  std::string simd;
  StepTrace trace;
  SolverState state;
};
Outcome run(const Case& c, Simd simd) {
  const ForcedSimd forced(simd_name(simd));
  const auto solver = oracle_test::make(c);
  Outcome o;
  o.simd = solver->info().driver;
  solver->step(3);
  o.trace = solver->inspection()->trace({});
  solver->step(4);
  o.state = solver->state();
  return o;
}

void check_same_bits(const Case& c) {
  const Outcome scalar = run(c, Simd::scalar);
  CHECK(scalar.simd == "scalar");
  for (const Simd simd : usable_simd()) {
    CAPTURE(simd_name(simd), c.particles.size());
    const Outcome lanes = run(c, simd);
    CHECK(lanes.simd == simd_name(simd));
    REQUIRE(lanes.trace.arrays.size() == scalar.trace.arrays.size());
    for (std::size_t k = 0; k < lanes.trace.arrays.size(); ++k) {
      const TraceArray &a = lanes.trace.arrays[k], &b = scalar.trace.arrays[k];
      CAPTURE(a.stage, a.iteration, a.quantity);
      CHECK(a.stage == b.stage);
      CHECK(a.values == b.values);
    }
    CHECK(lanes.trace.neighbor_begin == scalar.trace.neighbor_begin);
    CHECK(lanes.trace.neighbors == scalar.trace.neighbors);
    CHECK(lanes.state.position == scalar.state.position);
    CHECK(lanes.state.velocity == scalar.state.velocity);
    CHECK(lanes.state.id == scalar.state.id);
  }
}

/// Numbers that differ in every place and component.
template <class Real>
std::vector<Vec4<Real>> numbered(int n) {
  std::vector<Vec4<Real>> rows;
  for (int i = 0; i < n; ++i)
    rows.push_back({Real(4 * i), Real(4 * i + 1), Real(4 * i + 2), Real(4 * i + 3)});
  return rows;
}

template <class Real, int W>
void check_loads() {
  CAPTURE(W, sizeof(Real));
  const auto rows = numbered<Real>(W + 3);
  int index[W];
  for (int l = 0; l < W; ++l) index[l] = (7 * l + 2) % (W + 3);
  const GatheredRows<Vec4<Real>> all(rows.data());
  const auto a = load(all, Adjacent<W>{3}), s = load(all, Scattered<W>{index});
  for (int l = 0; l < W; ++l) {
    const auto is = [&](const Vec4<Lanes<Real, W>>& v, int row) {
      return v.x.v[l] == 4 * row && v.y.v[l] == 4 * row + 1 && v.z.v[l] == 4 * row + 2 &&
             v.w.v[l] == 4 * row + 3;
    };
    CHECK(is(a, 3 + l));
    CHECK(is(s, index[l]));
  }
  std::vector<Real> numbers;
  for (int i = 0; i < W + 3; ++i) numbers.push_back(Real(5 * i + 1));
  const GatheredRows<Real> one(numbers.data());
  const auto b = load(one, Adjacent<W>{3}), t = load(one, Scattered<W>{index});
  for (int l = 0; l < W; ++l) CHECK((b.v[l] == 5 * (3 + l) + 1 && t.v[l] == 5 * index[l] + 1));
  CHECK(load(one, 2) == 11);
  CHECK(load(one, Neighbor{1}) == 6);
}

}  // namespace

TEST_CASE("lanes of every width give the bits of one particle at a time, pass by pass",
          "[slow][simd]") {
  const bool dbl = GENERATE(false, true);
  const bool flat = GENERATE(false, true);
  // 315: no width divides it.
  Case c = flat ? flat_block(21, 15, 0.3, 0.4) : jittered_block(7, 5, 9, 0.3, 0.4);
  SECTION("defaults") {}
  SECTION("more than a chunk, two threads") {
    c = flat ? flat_block(39, 33, 0.3, 0.4) : jittered_block(13, 11, 9, 0.3, 0.4);
    c.scene.threads = 2;
  }
  SECTION("all terms") {
    c.scene.tensile = Tensile{0.01, 0.25, 4};
    c.scene.viscosity = Viscosity{0.3};
    c.scene.vorticity = Vorticity{20};
  }
  SECTION("the paper's kernels, two-sided, unfused, another power") {
    c.scene.solver.kernels = KernelMode::paper;
    c.scene.solver.constraint = ConstraintMode::two_sided;
    c.scene.solver.fused = false;
    c.scene.tensile = Tensile{0.01, 0.25, 3};
    c.scene.viscosity = Viscosity{0.3};
  }
  SECTION("h = 3 d, three substeps") {
    c.scene.fluid.smoothing_ratio = 3;
    c.scene.solver.substeps = 3;
  }
  SECTION("levels, and two substeps") {
    c.scene.solver.levels = LevelsMode::on;
    c.scene.solver.substeps = 2;
  }
  SECTION("particles in one place, lists of very different lengths") {
    for (std::size_t i = 1; i < 60; ++i) c.particles.position[i] = c.particles.position[0];
  }
  SECTION("one, two, three, and seventeen particles") {
    const std::size_t n = std::size_t(GENERATE(1, 2, 3, 17));
    c.particles.position.resize(n);
    c.particles.velocity.resize(n);
  }
  c.scene.precision = dbl ? Precision::dbl : Precision::single;
  check_same_bits(c);
}

TEST_CASE("a load of lanes brings each component of each row, or its one number, to its lane",
          "[simd]") {
  check_loads<float, 4>();
  check_loads<float, 8>();
  check_loads<float, 16>();
  check_loads<double, 2>();
  check_loads<double, 4>();
  check_loads<double, 8>();
}

TEST_CASE("PBF_SIMD takes what is usable and refuses the rest by name", "[simd]") {
  const auto error = [](const char* name) {
    const ForcedSimd forced(name);
    try {
      chosen_simd();
    } catch (const Error& e) {
      CHECK(std::string(e.what()).find("PBF_SIMD=" + std::string(name)) != std::string::npos);
      CHECK(std::string(e.what()).find("scalar, baseline") != std::string::npos);
      return e.code();
    }
    return ExitCode::done;
  };
  CHECK(error("sse9") == ExitCode::bad_input);
  CHECK(error("AVX2") == ExitCode::bad_input);
  CHECK(error("") == ExitCode::done);  // as if it were not set
  const std::vector<Simd> usable = usable_simd();
  for (const Simd simd : {Simd::scalar, Simd::baseline, Simd::avx2, Simd::avx512}) {
    const bool has = std::find(usable.begin(), usable.end(), simd) != usable.end();
    CHECK(error(simd_name(simd)) == (has ? ExitCode::done : ExitCode::unavailable));
  }
}
