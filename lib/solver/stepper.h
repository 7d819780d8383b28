// Executes programs: updates at full speed, updates pass by pass, and measurements of a state.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "lib/program/plan.h"
#include "lib/solver/executor.h"
#include "lib/solver/launch.h"
#include "lib/solver/launched_rows.h"
#include "lib/solver/other_rows.h"
#include "lib/solver/read_sums.h"
#include "lib/solver/results.h"
#include "lib/solver/stage_check.h"
#include "lib/solver/state_transfer.h"
#include "lib/solver/tracer.h"
#include "lib/solver/with_lists.h"

namespace pbf::PBF_VARIANT {

template <class Real, Executor Exec, class Features>
class Stepper {
 public:
  using Lists = typename Exec::Lists;
  using Saved = SavedState<Exec>;
  using Context = StepContext<Real, Exec, Features>;
  using Passes = typename Features::Passes;

  /// States and traces that the stepper returns are along the scene's axes.
  Stepper(Exec& exec, const Scene& scene, const Plan& plan, InternalState<Real> first)
      : plan_(plan), c_(exec, scene, plan), program_(&plan.program) {
    begin_rows(c_, first);
    c_.launched = int(first.id.size());
    c_.make(first);
    find_pairs();
    sum_density();
  }

  /// Updates (kernels/README.md, "The step"). The program may fuse the last pass of an update with
  /// the first of the next one.
  void step(int updates) {
    if (updates <= 0) return;
    c_.exec.begin();
    in_batch(c_, true);
    if (is_unfused(c_, *program_)) {
      for (int k = 0; k < updates && !has_lost_rows(c_); ++k) {
        wrap_rows(c_);
        run(program_->update);
      }
    } else if (has_other_ranks(c_)) {  // which look for lost rows before a sort, not behind it
      for (int k = 0; k < updates && !has_lost_rows(c_); ++k) {
        run(k == 0 ? program_->first : program_->next);
        run(program_->rest);
      }
      run(program_->last);
    } else {
      run(program_->first);
      for (int k = 1; k < updates; ++k) run(program_->rest_next);
      run(program_->rest_last);
    }
    in_batch(c_, false);
    moved();
  }

  /// The passes behind some updates (Program::between), with the lists of the update before.
  void between() { run(program_->between); }
  const Program& program() const { return *program_; }
  /// One update with the results of each stage.
  StepTrace trace(const TraceOptions& options) {
    Tracer<Context> t(c_, plan_.axes, options);
    step_seen([&](const PassInfo& pass, int number) { t.record(pass, number); });
    return t.result();
  }

  /// One update. Checks the results of each stage against `limits` and injects `fault`, unless
  /// these are null. `update`: its number; the first is 1.
  std::optional<StageEvent> step_checked(std::int64_t update, const StageLimits* limits,
                                         const Fault* fault) {
    StageCheck<Context> check(c_, plan_.axes, update, limits, fault);
    step_seen([&](const PassInfo& pass, int number) { check.look(pass, number); });
    return check.event();
  }
  int capacity() const { return c_.capacity(); }
  /// The present number of particles here, for which the host waits if it changes.
  int rows() { return c_.host_particles(c_.data(field::row_state)); }
  /// The same over all ranks.
  int particles() {
    if constexpr (has_ranks<Context>)
      if (auto* rows = c_.exec.rows()) return rows->particles();
    return rows();
  }
  /// What the addresses and numbers of launches follow from: recorded updates are valid for it.
  std::pair<int, int> launch() const { return {c_.placement(), c_.launched}; }
  /// Later steps use this scene, these parameters and this program.
  void use(const Scene& scene, const Params<Real>& p, const Program& program) {
    c_.scene = scene;
    c_.p = p;
    program_ = &program;
    forget();
  }
  /// To be called before each batch of steps, also before a repeated one.
  void before_steps(const StepRange& steps) {
    if constexpr (Context::changes_rows) {
      std::int64_t most = c_.host_rows();
      c_.for_features([&](auto& memory) { most += memory.new_rows(c_, steps); });
      c_.launched = int(std::min<std::int64_t>(launched_rows(most), c_.capacity()));
    }
    c_.for_features([&](auto& memory) { memory.before_steps(c_, steps); });
  }
  /// Largest number of steps between two such calls.
  std::int64_t most_steps() {
    auto most = std::numeric_limits<std::int64_t>::max();
    c_.for_features([&](auto& m) { most = std::min(most, m.most_steps(c_.scene, plan_)); });
    return most;
  }
  /// s, see lib/solver/state_transfer.h.
  double velocity_lag() { return pbf::velocity_lag(c_); }
  /// h^2/s^3: power per particle mass of the tank's inertial forces. lag: velocity_lag().
  double power(const FrameStep<double>& frame, double lag, double dt) {
    return motion_power(c_, rows(), frame, lag, dt);
  }
  /// The load of each wall since the last call with Interval::ends.
  std::vector<Load> loads(Interval interval) { return read_loads(c_, interval); }
  /// What took energy from the motion since the start: sums for dissipated().
  std::vector<DissipationSum> dissipation() { return read_dissipation(c_); }
  /// What emitters have brought and sinks taken, since the start.
  std::vector<EmissionSum> emission() { return read_emission(c_); }
  /// How the free bodies move.
  std::vector<BodyMotion> bodies() { return read_bodies(c_); }
  /// Readings of the gauges; means since the last call with Interval::ends.
  std::vector<double> gauges(Interval interval) { return read_gauges(c_, interval); }

  /// Leaves the rows of this rank alone, without images, before its state is read or kept. Updates
  /// go on with the same bits.
  void drop_ghosts() {
    const auto sort = [&] {
      c_.exec.begin();
      launch(Passes::template index_of<Sort>());
    };
    if (!drop_other_rows(c_, sort)) return;
    forget();
    moved();
  }
  std::vector<int> ids() { return c_.ids_in_order(c_.ids(), rows()); }
  /// A state with positions only.
  SolverState positions() {
    drop_ghosts();
    SolverState s;
    const int n = rows(), *order = c_.order_of_ids(c_.ids(), n);
    const char* from = c_.bytes_of(field::position);
    s.position = downloaded(c_, field::position, from, std::size_t(n), order);
    if constexpr (has_ranks<Context>)
      if (c_.exec.rows())  // not all particles
        for (const int id : ids()) s.id.push_back(id);
    return s;
  }
  SolverState state() {
    drop_ghosts();
    std::vector<const char*> present;
    for (const FieldInfo* f : plan_.program.state) present.push_back(c_.bytes_of(*f));
    return download_state(c_, present);
  }
  SolverState state(const Saved& s) { return download_state(c_, s.arrays()); }
  /// Sets a state with particles in any order. time: s since the start.
  void set_state(const SolverState& s, double time) {
    upload_state(c_, s);
    c_.launched = int(s.id.size());
    all_own_rows(c_, c_.launched);
    c_.for_features([&](auto& memory) { memory.stand(c_, time); });
    forget();
    moved();
  }
  void save(Saved& s) {
    if constexpr (has_ranks<Context>)
      if (auto* rows = c_.exec.rows())
        return s.save_rows(c_, {rows->first(), rows->last()}, rows->row_state());
    drop_ghosts();
    s.save(c_);
  }
  void restore(Saved& s) {
    s.restore(c_);
    all_own_rows(c_, rows());
    forget();
    moved();
  }
  /// Makes lists at the present positions unless there are some; true if it made them. The lists of
  /// the last update belong to its predicted positions, so a density summed over them would miss
  /// pairs that have come closer since. Rows are in the order of bin and id, so the additional sort
  /// changes no bit of later updates.
  bool find_pairs() {
    if (c_.lists_are_current) return false;
    c_.exec.begin();
    c_.booked_as = "measure";
    run(program_->lists);
    c_.booked_as = nullptr;
    return true;
  }
  /// Makes new lists at the present positions after the executor has enlarged their memory.
  void relist() {
    c_.make_lists();
    density_is_current_ = false;
    sum_density();
  }
  /// Sums at the present positions. Call find_pairs() first.
  MeasureSums measure(const MeasureConstants& given) {
    c_.exec.begin();
    sum_density();
    return measure_state(c_, particles(), given);
  }
  /// Densities need find_pairs() first.
  void ready_to_export(bool density) {
    c_.exec.begin();
    if (density) sum_density();
    c_.images() ? wrap_rows(c_) : drop_ghosts();  // rows of images are left out
  }
  /// Writes fields in SI units, along the scene's axes and in the order of ids to memory of the
  /// executor; null: not wanted. Call ready_to_export() first.
  template <class Out>
  void export_to(Out* position, Out* velocity, Out* density) {
    export_state(c_, position, velocity, density);
  }

  /// To be called after particles have moved, also by recorded updates (an even number of them):
  /// densities and lists are no longer current.
  void moved() { density_is_current_ = c_.lists_are_current = false; }

  std::size_t bytes() const { return c_.bytes() + c_.exec.bytes(); }

 private:
  void forget() {
    c_.for_features([&](auto& memory) { memory.forget(c_); });
  }
  void launch(int pass) {
    beside_.with(c_, pass, [&] { launch_pass<Passes>(pass, c_); });
    c_.exec.mark(c_.booked(Passes::texts[std::size_t(pass)].stage));
  }
  /// Several steps in one launch or beside each other, where the executor can.
  void run(const Steps& steps) {
    for (std::size_t k = 0; k < steps.size(); ++k)
      if (!take_turns(c_, steps, k) && !beside_.start(c_, steps, k, [&](int p) { launch(p); }))
        run(steps[k], [](int) {});
  }
  void run(const ProgramStep& s, const auto& seen) {
    if (s.kind == ProgramStep::pass) {
      launch(s.index);
      seen(s.index);
    } else if (s.kind == ProgramStep::iterate) {
      c_.iterating = true;
      for (int k = 0; k < s.times; ++k) {
        c_.iteration = s.first + k;
        ++c_.iterations;
        run(s.body, seen);
      }
      c_.iterating = false;
    } else {
      c_.exec.repeat_while("residual", c_.rows(), s.times, ResidualPass<Real>{c_.density()},
                           plan_.tolerance, &c_.data(field::counts)->repeats,
                           [&] { run(s.body, seen); });
    }
  }
  /// Calls seen(pass) after each pass, which may examine its results.
  void run(const Steps& steps, const auto& seen) {
    for (const ProgramStep& s : steps) run(s, seen);
  }

  /// One update without fused passes, with the bits of step(1). Calls seen(pass, number): number of
  /// the iteration since the lists were made, or else of the substep; 0 after the substeps.
  template <class Seen>
  void step_seen(const Seen& seen) {
    c_.exec.begin();
    int substep = -1;
    wrap_rows(c_);
    run(program_->update, [&](int index) {
      if (index == Passes::template index_of<Predict>()) ++substep;
      const bool start = index <= Passes::template index_of<MakeLists>();
      const int next = substep + (index == Passes::template index_of<MoveSolids>());
      seen(program_->passes[std::size_t(index)], c_.iterating ? c_.iterations : start ? next : 0);
    });
    moved();
  }

  void sum_density() {
    if (!std::exchange(density_is_current_, true))
      launch_pass<Passes>(Passes::template index_of<Density>(), c_);
  }

  const Plan& plan_;
  Context c_;
  const Program* program_;
  PassesBeside beside_;
  bool density_is_current_ = false;
};

}  // namespace pbf::PBF_VARIANT
