#include <fmt/core.h>
#include <algorithm>

#include "lib/base/error.h"
#include "lib/exec/make_solver.h"
#include "lib/run/prestabilize.h"
#include "lib/run/session.h"
#include "lib/run/settle.h"
#include "lib/run/start.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/random.h"
#include "lib/verify/compare_parts.h"

#ifdef PBF_HAS_DEFECT
namespace pbf::defect {  // compiled a second time, from changed sources (.cmake/defect.cmake)
std::unique_ptr<Solver> make_cpu_solver(const Scene&, const Plan&, Particles);
}
#endif

namespace pbf::verify_module {
namespace {

Scene on(const Scene& scene, const CompareSide& side) {
  Scene s = scene;
  s.output.reset();  // nothing is written, so that is nothing to hold memory for
  s.render.reset();
  s.checkpoint.reset();
  s.backend = side.backend;
  s.precision = side.precision;
  if (side.threads > 0) s.threads = side.threads;
  return s;
}

std::unique_ptr<Solver> make(const Scene& scene, const Plan& plan, const Particles& particles,
                             bool variant = false) {
#ifdef PBF_HAS_DEFECT
  if (variant) return defect::make_cpu_solver(scene, plan, particles);
#endif
  if (variant) throw Error(ExitCode::unavailable, "cpu+defect is not in this build");
  return make_solver(scene, plan, particles);
}

/// Calls f(x) for every real number of a state.
template <class F>
void for_each_real(SolverState& s, F&& f) {
  std::for_each(s.position.begin(), s.position.end(), f);
  std::for_each(s.velocity.begin(), s.velocity.end(), f);
  for (StoredField& field : s.fields)
    if (field.real) std::for_each(field.values.begin(), field.values.end(), f);
}

void round_to_float(SolverState& s) {
  for_each_real(s, [](double& x) { x = double(float(x)); });
}

/// Every key has its own random numbers, so that a new key does not change those of others.
SplitMix64 random_of(const Key& key, std::uint64_t seed) {
  for (const char c : key.path) seed = SplitMix64(seed + static_cast<unsigned char>(c)).next();
  return SplitMix64(seed);
}

/// Rounds the real numbers of a field, if present.
struct Round {
  double off;
  double u;
  SplitMix64& random;
  void operator()(double* x) const {
    if (*x != off) *x *= 1 + u * (2 * random.uniform() - 1);
  }
  template <std::ranges::range List>
  void operator()(List* values) const {
    if constexpr (std::is_same_v<std::ranges::range_value_t<List>, double>)
      for (double& x : *values) (*this)(&x);
  }
  template <class T>
  void operator()(std::optional<T>* value) const {
    if (*value) (*this)(&**value);
  }
  void operator()(const auto&) const {}
};

/// The scene with randomly rounded constants: an error that is the same for all particles and does
/// not average out.
Scene rounded(const Scene& scene, double u, std::uint64_t seed) {
  Scene s = scene;
  round_at_random(scene_table(), object(s), u, seed);
  return s;
}

/// The start of a frozen step: empty sums of loads and gauges, and values that the side of lower
/// precision can represent.
SolverState start_from(Solver& a, const Comparison& c) {
  c.take(a, 1);
  SolverState s = a.state();
  if (c.u == about(Precision::single).roundoff) round_to_float(s);
  return s;
}

/// Scenes that differ deliberately may have different loads and gauges.
void note_one_sided(const Comparison& c, CompareResult& result) {
  const std::vector<Reading> a = c.take(*c.a, 1), b = c.take(*c.b, 1);
  std::vector<std::string> found;
  for (const Reading& r : a)
    if (!find_reading(b, r.what)) found.push_back(r.what + " of A");
  for (const Reading& r : b)
    if (!find_reading(a, r.what)) found.push_back(r.what + " of B");
  if (!found.empty())
    result.notes.push_back(fmt::format(
        "{} loads and readings of gauges are on one side only and not compared, the first is {}",
        found.size(), found[0]));
}

}  // namespace

std::string CompareSide::name() const {
  std::string s = std::string(word(backend)) + (variant ? "+defect:" : ":") + word(precision);
  return threads > 0 ? s + "@" + std::to_string(threads) : s;
}

CompareSide parse_side(const std::string& text) {
  const auto fail = [&](const std::string& what) {
    bad_input("--between: \"" + text + "\"",
              what +
                  "; a side is BACKEND:PRECISION or BACKEND:PRECISION@THREADS, e.g. cpu:double, "
                  "cuda:float, cpu:float@2");
  };
  CompareSide side;
  const auto colon = text.find(':'), at = text.find('@');
  if (colon == std::string::npos || (at != std::string::npos && at < colon)) fail("no precision");
  std::string backend = text.substr(0, colon);
  if (backend == "cpu+defect") {
    side.variant = true;
#ifndef PBF_HAS_DEFECT
    fail("this build has no second CPU solver (configure with -DPBF_DEFECT=NAME)");
#endif
    backend = "cpu";
  }
  const std::optional<Backend> found = named<Backend>(backend);
  if (!found) fail("no backend \"" + backend + "\"");
  side.backend = *found;
  const std::string precision =
      text.substr(colon + 1, at == std::string::npos ? at : at - colon - 1);
  const std::optional<Precision> numbers = named<Precision>(precision);
  if (!numbers) fail("no precision \"" + precision + "\"");
  side.precision = *numbers;
  if (at != std::string::npos) {
    std::int64_t n = 0;
    if (read_number(text.substr(at + 1), n) != NumberError::none || n < 1 || n > 4096)
      fail("the number of threads is not a whole number from 1 to 4096");
    if (about(side.backend).on_device) fail("threads are the CPU's alone");
    side.threads = int(n);
  }
  return side;
}

void round_at_random(const KeyTable& table, const Object& object, double u, std::uint64_t seed) {
  for (const Key& key : table.keys) {
    const Block& block = *key.block;
    if (key.effect != Effect::results || key.exact || !block.is_present(object)) continue;
    SplitMix64 random = random_of(key, seed);
    for (std::size_t i = 0; i < block.size(object); ++i)
      if (const Object holder = block.entry(object, i); key.kinds & block.kind_of(holder))
        std::visit(Round{key.off, u, random}, key.field(holder));
  }
}

SolverState rounded(const SolverState& s, double u, std::uint64_t seed) {
  SplitMix64 random(seed);
  SolverState out = s;
  for_each_real(out, [&](double& x) { x *= 1 + u * (2 * random.uniform() - 1); });
  return out;
}

CompareResult compare_between(const Scene& scene_a, const Scene& scene_b, const std::string& dir,
                              const CompareSettings& settings,
                              const std::function<void(const std::string&)>& progress) {
  if (scene_a.bodies != scene_b.bodies || scene_a.fluid.spacing != scene_b.fluid.spacing ||
      scene_a.fluid.smoothing_ratio != scene_b.fluid.smoothing_ratio ||
      scene_a.domain.min != scene_b.domain.min)
    bad_input("--set-b",
              "both sides start from the same particles, so bodies, fluid.spacing, "
              "fluid.smoothing_ratio and domain.min must stay; give these to both with --set, or "
              "compare two run files");
  Start start_a = prepare(on(scene_a, settings.a), dir);
  settle(start_a, progress);
  const auto plan_of = [&](const Scene& s) {
    return make_plan(s, start_a.plan.particles, start_a.plan.start);
  };
  const Particles& particles = start_a.particles;
  const Scene &on_a = start_a.scene(), on_b = on(scene_b, settings.b);
  const Plan &plan_a = start_a.plan, plan_b = plan_of(on_b);
  const std::unique_ptr<Solver> a = make(on_a, plan_a, particles, settings.a.variant);
  const std::unique_ptr<Solver> b = make(on_b, plan_b, particles, settings.b.variant);
  Scene plain = on(scene_a, {Backend::cpu, Precision::dbl, 0, false});
  plain.solver.fused = false;  // a stored density can be rounded; its bits are the same
  const std::unique_ptr<Solver> reference = make(plain, plan_of(plain), particles);

  Comparison c{&settings, &plan_a, &on_a, &plan_b, &on_b, a.get(), b.get(), reference.get()};
  c.u = std::max(about(settings.a.precision).roundoff, about(settings.b.precision).roundoff);
  c.sides = settings.a.precision == settings.b.precision ? 2 : 1;
  const bool promised = settings.a.backend == settings.b.backend ||
                        (on_a.solver.reproducible && on_b.solver.reproducible);
  c.same_bits = promised && c.sides == 2 && !settings.a.variant && !settings.b.variant;
  c.progress = progress;
  if (!c.same_bits)
    for (int m = 0; m < settings.members; ++m) {
      const Scene member = rounded(plain, c.u, settings.seed + std::uint64_t(m));
      c.members.push_back(make(member, plan_of(member), particles));
    }

  CompareResult result;
  result.a = settings.a.name();
  result.b = settings.b.name();
  result.notes.push_back(
      fmt::format("scene \"{}\", {} particles, {} updates on {} before the frozen step",
                  scene_a.name, plan_a.particles, settings.warmup, result.a));
  if (scene_a.time.adaptive || scene_b.time.adaptive)
    result.notes.push_back("time.adaptive is left out: every update is one step");
  note_one_sided(c, result);
  // The others take over A's state.
  const std::string relieved = prestabilized_text(prestabilize(*a, on_a, plan_a));
  if (!relieved.empty()) result.notes.push_back(relieved);
  if (progress) progress(fmt::format("{} updates of warm-up on {}", settings.warmup, result.a));
  advance(*a, settings.warmup);
  const SolverState start = start_from(*a, c);
  result.parts.push_back(compare_stages(c, start, result));
  if (progress) progress("frozen step: " + result.parts[0].finding);
  std::int64_t failure = -1;
  for (auto& part : compare_course(c, start, result, failure))
    result.parts.push_back(std::move(part));
  // Without a finding in the frozen step, try later ones: just before the failure, and the last.
  for (const std::int64_t after : {failure - 1, std::int64_t(settings.updates)}) {
    if (!result.stage.empty() || failure < 1) break;
    a->set_state(start);
    advance(*a, after);
    const SolverState later = start_from(*a, c);
    ComparePart part = compare_stages(c, later, result);
    part.name = fmt::format("frozen step at update {}", later.updates);
    result.parts.push_back(std::move(part));
  }
  return result;
}

}  // namespace pbf::verify_module
