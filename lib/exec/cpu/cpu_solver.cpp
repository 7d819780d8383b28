#include "lib/exec/cpu/cpu_solver.h"

#include <new>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/machine.h"
#include "lib/base/start_thread.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "lib/program/threads.h"
#include "lib/solver/step_solver.h"

namespace pbf::inline PBF_VARIANT {
namespace {

template <class Real>
class CpuSolver final : public Solver {
 public:
  CpuSolver(const Scene& scene, const Plan& plan, Particles particles)
      : scene_(scene),
        plan_(plan),
        n_(std::int64_t(particles.size())),
        exec_(solver_threads(scene, n_), cpu_list_entries(scene)) {
    Stopwatch watch;
    InternalState<Real> s = to_internal<Real>(scene, plan.axes, std::move(particles));
    stepper_ = std::make_unique<Stepper<Real, CpuExec>>(
        exec_, make_params<Real>(scene, plan), scene.solver.kernels, scene.solver.iterations, plan,
        std::move(s.position), std::move(s.velocity), std::move(s.id));
    init_seconds_ = watch.seconds();
    init_entries_ = exec_.clock().entries();
  }

  void step(int updates) override {
    if (fault_) {
      for (int k = 0; k < updates; ++k) checked_step(nullptr);
      return;
    }
    if (level_ == 0)
      stepper_->step(updates);
    else
      for (int k = 0; k < updates; ++k) stepper_->step(1 << level_);
    count(updates);
  }
  void set_step_level(int level) override {
    if (level == level_) return;
    level_ = level;
    stepper_->set_params(params_at_level(scene_, plan_, level, stepper_->params()));
  }
  void relax(int steps, double damping) override {
    const Params<Real> p = stepper_->params();
    stepper_->set_params(without_time(p, damping));
    stepper_->step(steps);
    stepper_->set_params(p);
    steps_ += steps;
  }

  std::vector<double> positions() override { return stepper_->positions(); }
  Snapshot download(const std::vector<std::string>& fields, ScalarType type) override {
    Snapshot s = empty_snapshot(fields, type, std::size_t(n_), updates_, time());
    type == ScalarType::f64 ? fill<double>(s) : fill<float>(s);
    return s;
  }

  Measures measure() override {
    return to_measures(stepper_->measure(), scene_, plan_, updates_, steps_);
  }

  SolverState state() override { return stepper_->state(updates_, steps_); }
  void set_state(const SolverState& s) override {
    check_state(s, n_);
    stepper_->set_state(s);
    updates_ = s.updates;
    steps_ = s.steps;
  }
  StepTrace trace(const TraceOptions& options) override {
    refuse_trace(level_);
    count(1);
    return stepper_->trace(options);
  }

  void keep() override {
    stepper_->save(kept_);
    kept_updates_ = updates_;
    kept_steps_ = steps_;
  }
  SolverState kept() override {
    if (kept_.id.size() == 0) throw Error(ExitCode::internal, "kept() before keep()");
    return stepper_->state(kept_, kept_updates_, kept_steps_);
  }
  void watch_speed(double speed) override { stepper_->watch_speed(speed / scene_.h()); }
  std::optional<StageEvent> step_checked(const StageLimits& limits) override {
    return checked_step(&limits);
  }
  void inject(const Fault& fault) override { fault_ = fault; }

  std::vector<StageTime> timings() const override {
    std::vector<StageTime> out{{"init", init_seconds_, 1}};
    for (const auto& e : exec_.clock().entries()) {
      double before = 0;  // sorting the first state is part of init, not of the updates
      for (const auto& b : init_entries_)
        if (b.name == e.name) before = b.seconds;
      out.push_back({e.name, e.seconds - before, e.calls});
    }
    return out;
  }

  SolverInfo info() const override {
    SolverInfo i;
    i.backend = "cpu";
    i.precision = sizeof(Real) == 8 ? "double" : "float";
    i.device = cpu_model();
    i.driver = simd_name(exec_.simd());
    i.threads = exec_.threads();
    i.vol = plan_.vol;
    i.wall_scale = plan_.wall_scale;
    i.bytes = stepper_->bytes() + kept_.bytes();
    return i;
  }

  std::int64_t updates_done() const override { return updates_; }
  double time() const override { return double(updates_) * scene_.time.step; }

 private:
  void count(int updates) {
    updates_ += updates;
    steps_ += std::int64_t(updates) << level_;
  }
  /// limits may be null.
  std::optional<StageEvent> checked_step(const StageLimits* limits) {
    std::optional<StageEvent> first;
    for (int s = 0; s < 1 << level_; ++s) {
      const auto event = stepper_->step_checked(updates_ + 1, limits, fault_ ? &*fault_ : nullptr);
      if (!first) first = event;
    }
    count(1);
    return first;
  }
  template <class Out>
  static Out* array(Snapshot& s, const char* name) {
    for (auto& f : s.fields)
      if (f.name == name) return f.as<Out>().data();
    return nullptr;
  }
  template <class Out>
  void fill(Snapshot& s) {
    stepper_->export_to(scene_.h(), scene_.fluid.rest_density, scene_.origin(),
                        array<Out>(s, "position"), array<Out>(s, "velocity"),
                        array<Out>(s, "density"));
  }

  Scene scene_;
  Plan plan_;
  std::int64_t n_;
  CpuExec exec_;
  std::unique_ptr<Stepper<Real, CpuExec>> stepper_;
  double init_seconds_ = 0;
  std::vector<StageClock::Entry> init_entries_;
  int level_ = 0;
  std::int64_t updates_ = 0, steps_ = 0, kept_updates_ = 0, kept_steps_ = 0;
  typename Stepper<Real, CpuExec>::Saved kept_;
  std::optional<Fault> fault_;
};

}  // namespace

std::unique_ptr<Solver> make_cpu_solver(const Scene& scene, const Plan& plan,
                                        Particles particles) try {
  require_threads(solver_threads(scene, plan.particles));
  if (scene.precision == Precision::dbl)
    return std::make_unique<CpuSolver<double>>(scene, plan, std::move(particles));
  return std::make_unique<CpuSolver<float>>(scene, plan, std::move(particles));
} catch (const std::bad_alloc&) {
  throw Error(ExitCode::unavailable, "not enough memory for " + std::to_string(plan.particles) +
                                         " particles; increase fluid.spacing, or use a machine "
                                         "with more memory (pbf plan says how much)");
}

}  // namespace pbf::inline PBF_VARIANT
