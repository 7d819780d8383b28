// The solver over any executor. Host side only.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/stage_clock.h"
#include "lib/program/make_program.h"
#include "lib/program/time_levels.h"
#include "lib/solver/batch.h"
#include "lib/solver/diagnostics.h"
#include "lib/solver/executor.h"
#include "lib/solver/solver.h"
#include "lib/solver/stepper.h"

namespace pbf::solver_module {

/// A snapshot of n particles with allocated arrays and filled ids. It has position and id, and
/// velocity and density if `fields` names them. Throws Error(bad_input) for another name.
Snapshot empty_snapshot(const std::vector<std::string>& fields, ScalarType type, std::size_t n,
                        std::int64_t update, double time);

}  // namespace pbf::solver_module

namespace pbf::PBF_VARIANT {

/// Updates before the host first checks for lists that overflowed. Few at the start and after an
/// overflow: overflows often come in a row, and all updates since the last check are repeated.
constexpr int kFirstBatch = 8;

/// Features: those of plan.program.
template <class Real, Executor Exec, class Features = pbf::Features>
class StepSolver final : public Solver, public Inspection {
 public:
  /// `executor`: arguments of the executor's constructor.
  template <class... Args>
  StepSolver(const Scene& scene, const Plan& plan, Particles particles, Args&&... executor)
      : scene_(scene),
        plan_(plan),
        without_time_(make_program_of<Features>(scene, plan.shape(), true)),
        exec_(std::forward<Args>(executor)...) {
    bool part = false;  // of several ranks
    if constexpr (requires { exec_.rows(); }) part = exec_.rows() != nullptr;
    if (!part && plan.particles != std::int64_t(particles.size()))
      throw Error(ExitCode::internal, "the plan is one of another number of particles");
    const Stopwatch watch;
    InternalState<Real> s = to_internal<Real>(scene, plan.axes, std::move(particles));
    stepper_ = std::make_unique<Stepping>(exec_, scene_, plan_, std::move(s));
    while (exec_.grow_lists(stepper_->capacity())) stepper_->relist();
    exec_.forget_stages();  // sorting the initial state belongs to init, not to the updates
    init_seconds_ = watch.seconds();
  }

  void step(int updates, const StepOptions& options) override {
    const Stopwatch watch;
    use(options);
    if (options.without_time) {
      advance(updates);
      steps_ += updates;
    } else {
      for (; fault_ && updates > 0; --updates) checked_step(nullptr);
      advance(std::int64_t(updates) << options.level);
      count(updates);
    }
    step_seconds_ += watch.seconds();
  }

  std::future<Snapshot> download(const std::vector<std::string>& fields, ScalarType type) override {
    const bool density = std::ranges::find(fields, "density") != fields.end();
    if (density) find_pairs();
    stepper_->ready_to_export(density);
    auto snapshot =
        std::make_shared<Snapshot>(empty_snapshot(fields, type, std::size_t(stepper_->rows()),
                                                  updates_, double(updates_) * scene_.time.step));
    snapshot->bodies = stepper_->bodies();
    if (changes_rows(scene_))
      std::ranges::copy(stepper_->ids(), snapshot->fields.back().as<std::int32_t>().begin());
    type == ScalarType::f64 ? start_export<double>(*snapshot) : start_export<float>(*snapshot);
    return std::async(std::launch::deferred, [this, snapshot] {
      exec_.finish_copy(targets(*snapshot));
      return std::move(*snapshot);
    });
  }

  Diagnostics diagnose() override {
    find_pairs();
    const int n = stepper_->particles();
    const MeasureConstants given = measure_constants(scene_, plan_, n);
    Diagnostics m = to_diagnostics(stepper_->measure(given), n, given, stepper_->velocity_lag(),
                                   scene_, plan_, updates_, steps_);
    measure_motion(m);
    return m;
  }

  std::vector<double> readings(Series series, Interval interval) override {
    if (series == Series::gauges) return stepper_->gauges(interval);
    std::vector<double> all = load_readings(stepper_->loads(interval), scene_, plan_);
    for (const double e : dissipated(stepper_->dissipation(), scene_, plan_)) all.push_back(e);
    const double time = double(updates_) * scene_.time.step;
    for (const double e : emission_readings(stepper_->emission(), scene_, plan_, time))
      all.push_back(e);
    return all;
  }

  SolverState state(StateOf which) override {
    if (which == StateOf::positions) return stepper_->positions();
    const bool kept = which == StateOf::kept;
    if (kept && kept_.empty()) throw Error(ExitCode::internal, "no state was kept");
    SolverState s = kept ? stepper_->state(kept_) : stepper_->state();
    s.updates = kept ? kept_updates_ : updates_;
    s.steps = kept ? kept_steps_ : steps_;
    return s;
  }
  void set_state(const SolverState& s) override {
    check_state(s, plan_.most_particles(), changes_rows(scene_));
    stepper_->set_state(s, double(s.updates) * scene_.time.step);
    updates_ = s.updates;
    steps_ = s.steps;
  }
  void keep() override {
    stepper_->save(kept_);
    kept_updates_ = updates_;
    kept_steps_ = steps_;
  }

  SolverInfo info() const override {
    SolverInfo i;
    i.precision = word(precision_of<Real>);
    i.vol = plan_.vol;
    i.wall_scale = plan_.wall_scale;
    i.bytes = stepper_->bytes() + saved_.bytes() + kept_.bytes();
    exec_.describe(i);
    i.stages = {{"init", init_seconds_, 1}};
    for (StageTime& s : exec_.stages(step_seconds_)) i.stages.push_back(std::move(s));
    return i;
  }
  std::int64_t updates() const override { return updates_; }

  Inspection* inspection() override { return this; }
  StepTrace trace(const TraceOptions& options) override {
    use({0, options_.watched_speed, {}});
    StepTrace t;
    until_lists_fit(
        [&] {
          before_steps(0, 1);
          t = stepper_->trace(options);
          between(1);
        },
        [] {});
    count(1);
    return t;
  }
  std::optional<StageEvent> step_checked(const StageLimits& limits,
                                         const StepOptions& options) override {
    use(options);
    return checked_step(&limits);
  }
  void inject(const Fault& fault) override { fault_ = fault; }

 private:
  using Stepping = Stepper<Real, Exec, Features>;

  /// Does `left` steps in batches and checks for lists that overflowed after each batch.
  void advance(std::int64_t left) {
    const std::int64_t most = stepper_->most_steps();
    for (std::int64_t done = 0; left > 0;) {
      int batch = int(std::min({left, std::int64_t(batch_), most}));
      until_lists_fit(
          [&] {
            before_steps(done, batch);
            Batch<Stepping> steps(*stepper_, at(done), steps_between());
            exec_.repeat(batch, steps);
          },
          [&] { batch = batch_ = std::min(batch, kFirstBatch); });
      left -= batch;
      done += batch;
      batch_ = int(std::min<std::int64_t>(2 * std::int64_t(batch_),
                                          exec_.largest_batch(stepper_->capacity())));
    }
  }
  /// The passes between updates, if they come behind this step.
  void between(std::int64_t done) {
    const std::int64_t every = steps_between();
    if (every == 0 || at(done) % every != 0) return;
    exec_.begin();
    stepper_->between();
  }
  /// From one time of these passes to the next; 0: there are none.
  std::int64_t steps_between() const {
    return std::int64_t(stepper_->program().between_every) << options_.level;
  }
  /// The number of a step of the present length. done: steps since the last counted update.
  std::int64_t at(std::int64_t done) const { return (updates_ << options_.level) + done; }
  /// Runs `work`, after which lists are no longer current. While a list did not fit, restores the
  /// state before it, enlarges the lists, calls again() and repeats `work`.
  template <class Work, class Again>
  void until_lists_fit(const Work& work, const Again& again) {
    if constexpr (Exec::lists_overflow) stepper_->save(saved_);
    work();
    while (exec_.grow_lists(stepper_->capacity())) {
      stepper_->restore(saved_);
      again();
      work();
    }
    if constexpr (Exec::lists_overflow) exec_.enlarge_lists(stepper_->capacity());
  }
  void before_steps(std::int64_t done, int steps) {
    const int n = plan_.substeps;
    stepper_->before_steps(
        {at(done) * n, steps * n, scene_.time.step / double(std::int64_t(n) << options_.level)});
  }
  void measure_motion(Diagnostics& m) {
    m.inflow = inflow_energy(stepper_->emission(), scene_, plan_);
    m.moved = has_work(scene_) || comes_and_goes(scene_);
    const double unit = plan_.mass * scene_.h() * scene_.h();
    const double lag = m.velocity_lag, dt = scene_.time.step;
    if (scene_.tank_motion)
      m.power += unit * stepper_->power(frame_step(scene_, plan_.axes, m.time - lag, dt), lag, dt);
    m.bodies = stepper_->bodies();
    if (has_moving_obstacles(scene_))
      for (const Load& l : stepper_->loads(Interval::goes_on)) m.solid_work += unit * l.work;
  }

  void use(const StepOptions& options) {
    if (options == options_) return;
    options_ = options;
    const Scene scene = scene_at_level(scene_, options.level);
    Params<Real> p = make_params<Real>(scene, plan_);
    if (!p.limit_speed) {
      const double speed = options.watched_speed / scene_.h();
      p.speed_squared = Real(std::min(speed * speed, 1e30));
    }
    options.without_time
        ? stepper_->use(scene, without_time(p, *options.without_time), without_time_)
        : stepper_->use(scene, p, plan_.program);
    exec_.forget_recorded();  // recordings contain the parameters
  }
  void count(int updates) {
    updates_ += updates;
    steps_ += std::int64_t(updates) << options_.level;
  }

  /// limits may be null.
  std::optional<StageEvent> checked_step(const StageLimits* limits) {
    std::optional<StageEvent> first, event;
    for (int s = 0; s < 1 << options_.level; ++s) {
      until_lists_fit(
          [&] {
            before_steps(s, 1);
            event = stepper_->step_checked(updates_ + 1, limits, fault_ ? &*fault_ : nullptr);
            between(s + 1);
          },
          [] {});
      if (!first) first = event;
    }
    count(1);
    return first;
  }

  void find_pairs() {
    if (!stepper_->find_pairs()) return;
    while (exec_.grow_lists(stepper_->capacity())) stepper_->relist();
  }

  static std::vector<CopyTarget> targets(Snapshot& s) {
    std::vector<CopyTarget> to;
    for (FieldArray& f : s.fields)
      if (f.name != "id") to.push_back({f.bytes.data(), f.bytes.size()});
    return to;
  }
  template <class Out>
  void start_export(Snapshot& s) {
    const bool velocity = s.find("velocity"), density = s.find("density");
    exec_.template start_copy<Out>(targets(s), [&](const std::vector<Out*>& to) {
      stepper_->export_to(to[0], velocity ? to[1] : nullptr, density ? to.back() : nullptr);
    });
  }

  const Scene scene_;
  const Plan plan_;
  const Program without_time_;
  Exec exec_;
  std::unique_ptr<Stepping> stepper_;
  typename Stepping::Saved saved_, kept_;
  StepOptions options_;
  std::optional<Fault> fault_;
  int batch_ = Exec::lists_overflow ? kFirstBatch : 1 << 30;
  double init_seconds_ = 0, step_seconds_ = 0;
  std::int64_t updates_ = 0, steps_ = 0, kept_updates_ = 0, kept_steps_ = 0;
};

}  // namespace pbf::PBF_VARIANT
