// The step, written once, over an executor. An executor supplies: Lists (the neighbour policy),
// Buffer<T>, for_each(n, pass), sort_by_bin, build_lists, reduce, to_host, and mark(stage).
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "kernels/pass_delta.h"
#include "kernels/pass_export.h"
#include "kernels/pass_lambda.h"
#include "kernels/pass_measure.h"
#include "kernels/pass_predict.h"
#include "kernels/pass_residual.h"
#include "kernels/pass_vorticity.h"
#include "kernels/pass_xsph.h"
#include "lib/solver/as_types.h"
#include "lib/solver/compression_percentile.h"
#include "lib/solver/particle_arrays.h"
#include "lib/solver/stage_check.h"
#include "lib/solver/state_transfer.h"
#include "lib/solver/tracer.h"

namespace pbf::inline PBF_VARIANT {

template <class Real, class Exec>
class Stepper {
 public:
  using Lists = typename Exec::Lists;

  /// State in the internal frame. Positions and velocities are in the order of ids 0..n-1.
  Stepper(Exec& exec, const Params<Real>& params, KernelMode mode, int iterations, const Plan& plan,
          std::vector<Vec4<Real>> position, std::vector<Vec4<Real>> velocity, std::vector<int> id)
      : exec_(exec),
        p_(params),
        mode_(mode),
        iterations_(iterations),
        substeps_(plan.substeps),
        more_rounds_(plan.more_rounds),
        residual_limit_(residual_limit(plan.tolerance, params.n)),
        fused_(plan.fused),
        tensile_(plan.tensile) {
    for (int k = 0; k < iterations; ++k)
      step_length_.push_back(
          Real(plan.step_length *
               (plan.sweep_factors.empty() ? 1 : plan.sweep_factors[std::size_t(k)])));
    a_.make(exec_, p_, position, velocity, id);
    reorder_as_is("grid");
    sum_density();
  }

  /// Updates (kernels/README.md, "The step"). Where only viscosity lies between a sweep and the
  /// next update, one pass does both that and the next bins.
  void step(int updates) {
    if (updates <= 0) return;
    unsort();
    exec_.begin();
    if (!has_pairs()) {
      for (int k = updates * substeps_; k > 0; --k) move();
      moved();
      return;
    }
    const auto unseen = [](const char*, int) {};
    bool moved_on = false;
    for (int left = updates - 1; left >= 0; --left) {
      if (!moved_on)
        with_dimensions(p_.dimensions, [&](auto d) {
          reorder<true>("predict", PredictPass<Real, decltype(d)::value>{
                                       p_, a_.position.data(), a_.velocity.data(), a_.bin.data()});
        });
      moved_on = left > 0 && p_.xsph > Real(0) && !(p_.vorticity > Real(0));
      solve(unseen, true);
      if (moved_on)
        with_smoothing(mode_, p_.dimensions,
                       [&](auto s) { reorder<true>("xsph", xsph<decltype(s)::value, true>()); });
      else
        finish_update(unseen);
    }
    moved();
  }

  /// One update, with what each stage left behind.
  StepTrace trace(const TraceOptions& options) {
    Tracer<Real, Exec> t(exec_, p_.n, options);
    step_seen([&](const char* stage, int sweep) { record(t, stage, sweep); });
    return t.result();
  }

  /// One update, looking at what each stage left behind and putting a fault in, where these are not
  /// null. `update`: its number, the first is 1.
  std::optional<StageEvent> step_checked(std::int64_t update, const StageLimits* limits,
                                         const Fault* fault) {
    StageCheck<Real, Exec> check(exec_, p_, update, limits, fault);
    step_seen([&](const std::string& stage, int sweep) {
      const bool lists = stage == "neighbors";
      if (lists) exec_.for_each(p_.n, ListSizePass<Lists>{lists_, a_.sort_order()});  // free by now
      check.look(stage, sweep,
                 {(stage == "lambda" ? a_.other_position : a_.position).data(), a_.velocity.data(),
                  stage == "density" ? a_.density.data() : nullptr, a_.id.data(),
                  lists ? a_.sort_order() : nullptr});
    });
    return check.event();
  }

  /// Others differ in what goes with the time step.
  const Params<Real>& params() const { return p_; }
  void set_params(const Params<Real>& p) { p_ = p; }

  /// Particles faster than `speed` (h/s) are counted; no effect where the scene limits the speed.
  void watch_speed(double speed) {
    if (!p_.limit_speed) p_.speed_squared = Real(std::min(speed * speed, 1e30));
  }

  SolverState state(std::int64_t updates, std::int64_t steps) {
    return download_state<Real>(exec_, std::size_t(p_.n), a_.unsorted_state(), updates, steps);
  }

  /// Takes over a state of as many particles. What measures it before the next update needs lists,
  /// and these a sort; the order of the state itself comes back with the update.
  void set_state(const SolverState& s) {
    unsort();
    upload_state<Real>(exec_, s, a_.state());
    sort_for_measure();
    density_is_current_ = false;
    sum_density();
  }

  /// Puts the particles back into the order that they had before a sort that no update made.
  void unsort() {
    // The copy was for set_state(), or the next measure needs it.
    if (a_.take_back(exec_, !lists_last())) density_is_current_ = false;
  }

  /// Whether an update looks at pairs. Without sweeps, viscosity and vorticity it only moves
  /// particles, and lists are made where a measure or a download asks for the density.
  bool has_pairs() const { return iterations_ > 0 || p_.xsph > Real(0) || p_.vorticity > Real(0); }

  /// Whether the lists of an update still name all pairs at its end. Not those that substeps
  /// share: particles that met since are not in them, and a compression summed with them is up to
  /// a third too small (README.md).
  bool lists_last() const { return has_pairs() && substeps_ == 1; }

  /// Makes lists at the present positions, where there are none, and says so. The particles go back
  /// into their order with the next update: how often a run is measured must not change it.
  bool find_pairs() {
    if (lists_are_current_) return false;
    sort_for_measure();
    return true;
  }

  /// Sums at the present positions, with the lists of the update where they last.
  MeasureSums measure() {
    exec_.begin();
    find_pairs();
    sum_density();
    auto sums = exec_.reduce(
        p_.n, MeasurePass<Real, Lists>{p_, lists_, a_.position.data(), a_.velocity.data(),
                                       a_.density.data(), a_.counts.data()});
    sums.compression_p99 = compression_percentile(
        exec_.count_in_bins(p_.n, kCompressionBins, CompressionBinPass<Real>{a_.density.data()}),
        p_.n - p_.n / 100, p_.n, sums.compression_max);
    exec_.mark("measure");
    return sums;
  }

  /// SI units, id order, into device-visible buffers; null where not asked for.
  template <class Out>
  void export_to(double h, double rest_density, const Double3& origin, Out* position, Out* velocity,
                 Out* density) {
    exec_.begin();
    if (density) {
      find_pairs();
      sum_density();
    }
    exec_.for_each(p_.n, ExportPass<Real, Out>{h,
                                               rest_density,
                                               {origin[0], origin[1], origin[2]},
                                               a_.position.data(),
                                               a_.velocity.data(),
                                               a_.density.data(),
                                               a_.id.data(),
                                               position,
                                               velocity,
                                               density});
    exec_.mark("download");
  }

  /// What a replay of recorded updates (an even number of them) leaves behind on the host: nothing
  /// that was summed or listed before holds.
  void moved() {
    density_is_current_ = false;
    lists_are_current_ = lists_last();
  }

  /// New lists at the present positions, after the executor has been given more room for them.
  void relist() {
    lists_ = exec_.build_lists(a_.position.data(), a_.bin_start.data(), p_);
    density_is_current_ = false;
    sum_density();
  }

  using Saved = typename ParticleArrays<Real, Exec>::Saved;
  void save(Saved& s) { a_.save(exec_, s); }
  void restore(Saved& s) {
    a_.restore(exec_, s);
    density_is_current_ = false;
  }
  SolverState state(Saved& s, std::int64_t updates, std::int64_t steps) {
    return download_state<Real>(exec_, std::size_t(p_.n), s.state(), updates, steps);
  }

  std::size_t bytes() const { return a_.bytes() + exec_.list_bytes(); }

 private:
  /// One update, one pass after the other: the bits of step(1). `seen(stage, sweep)` may look at
  /// what each stage left behind.
  template <class Seen>
  void step_seen(const Seen& seen) {
    unsort();
    exec_.begin();
    move();
    seen("predict", 0);
    reorder_as_is("predict");
    seen("grid", 0);
    seen("neighbors", 0);
    solve(seen, false);
    finish_update(seen);
    moved();
  }

  void sort_for_measure() {
    a_.put_aside(exec_);
    reorder_as_is("grid");
  }

  /// Runs the pass that gives every particle its bin, sorts and gathers the particles by bin (as
  /// predicted, with `moving`), makes the lists.
  template <bool moving, class First>
  void reorder(const char* stage, const First& first) {
    exec_.sort_by_bin(
        stage, first, p_.n, bin_count(p_), a_.sort_order(), a_.bin_start.data(),
        GatherPass<Real, moving>{p_, a_.position.data(), a_.velocity.data(), a_.id.data(),
                                 a_.other_position.data(), a_.other_velocity.data(),
                                 a_.other_id.data(), a_.counts.data()});
    a_.swap();
    exec_.mark("grid");
    lists_ = exec_.build_lists(a_.position.data(), a_.bin_start.data(), p_);
    lists_are_current_ = true;
    exec_.mark("neighbors");
  }

  /// x* and the velocity that goes with it, in place.
  void move() {
    exec_.for_each(p_.n,
                   MovePass<Real>{p_, a_.position.data(), a_.velocity.data(), a_.counts.data()});
    exec_.mark("predict");
  }

  /// The same with the positions as they are.
  void reorder_as_is(const char* stage) {
    with_dimensions(p_.dimensions, [&](auto d) {
      reorder<false>(stage,
                     BinPass<Real, decltype(d)::value>{p_, a_.position.data(), a_.bin.data()});
    });
  }

  /// The sweeps of the first substep, whose x* is there already, then the other substeps with the
  /// same lists. Rounds of sweeps go on while the mean compression that the last sweep found is
  /// above the tolerance. `seen(stage, sweep)` may look at what each stage left behind. With
  /// `joined`, the last sweep of a substep also takes the particles to the next one: the same
  /// arithmetic in one launch less.
  template <class Seen>
  void solve(const Seen& seen, bool joined) {
    joined = joined && iterations_ > 0 && more_rounds_ == 0;
    int number = 0;
    for (int s = 0; s < substeps_; ++s) {
      if (s > 0 && !joined) {
        move();
        seen("predict", s);
      }
      with_smoothing(mode_, p_.dimensions, [&](auto smoothing) {
        const auto round = [&] {
          for (int k = 0; k < iterations_; ++k) {
            p_.step_length = step_length_[std::size_t(k)];
            const bool moves_on = joined && k == iterations_ - 1 && s < substeps_ - 1;
            sweep<decltype(smoothing)::value>(seen, ++number, moves_on);
          }
        };
        round();
        if (more_rounds_ > 0)
          exec_.repeat_while("residual", p_.n, more_rounds_, ResidualPass<Real>{a_.density.data()},
                             residual_limit_, &a_.counts.data()->rounds, round);
      });
    }
  }

  /// What comes after the sweeps, in passes of their own.
  template <class Seen>
  void finish_update(const Seen& seen) {
    if (p_.xsph > Real(0)) {
      with_smoothing(mode_, p_.dimensions,
                     [&](auto s) { exec_.for_each(p_.n, xsph<decltype(s)::value, false>()); });
      exec_.mark("xsph");
      seen("xsph", 0);
    }
    if (!(p_.vorticity > Real(0))) return;
    with_dimensions(p_.dimensions, [&](auto d) {
      constexpr int D = decltype(d)::value;
      exec_.for_each(p_.n, CurlPass<Real, Lists, D>{p_, lists_, a_.position.data(),
                                                    a_.velocity.data(), a_.curl.data()});
      seen("curl", 0);
      exec_.for_each(p_.n, VorticityPass<Real, Lists, D>{p_, lists_, a_.position.data(),
                                                         a_.curl.data(), a_.velocity.data()});
    });
    exec_.mark("vorticity");
    seen("vorticity", 0);
  }

  template <Smoothing S, class Seen>
  void sweep(const Seen& seen, int number, bool moves_on) {
    if (!fused_) {
      exec_.for_each(
          p_.n, DensityPass<Real, Lists, S>{p_, lists_, a_.position.data(), a_.density.data()});
      exec_.mark("density");
      seen("density", number);
    }
    with_bool(fused_, [&](auto fused) {
      exec_.for_each(
          p_.n, LambdaPass<Real, Lists, S, decltype(fused)::value>{
                    p_, lists_, a_.position.data(), a_.other_position.data(), a_.density.data()});
    });
    exec_.mark("lambda");
    seen("lambda", number);
    with_bool(tensile_, [&](auto tensile) {
      exec_.for_each(
          p_.n, DeltaPass<Real, Lists, S, decltype(tensile)::value>{
                    p_, lists_, a_.other_position.data(), a_.density.data(), a_.position.data(),
                    a_.velocity.data(), moves_on ? a_.counts.data() : nullptr});
    });
    exec_.mark("delta");
    seen("delta", number);
  }

  void record(Tracer<Real, Exec>& t, const std::string& stage, int sweep) {
    t.record(stage, sweep,
             {a_.position.data(), a_.other_position.data(), a_.velocity.data(), a_.curl.data(),
              a_.density.data(), a_.bin.data(), a_.id.data(), a_.other_id.data(), fused_},
             lists_);
  }

  /// The pass over the present velocities, which it leaves behind in the other array.
  template <Smoothing S, bool more_to_come>
  XsphPass<Real, Lists, S, more_to_come> xsph() {
    std::swap(a_.velocity, a_.other_velocity);
    return {p_,           lists_, a_.position.data(), a_.other_velocity.data(), a_.velocity.data(),
            a_.bin.data()};
  }

  void sum_density() {
    if (density_is_current_) return;
    with_smoothing(mode_, p_.dimensions, [&](auto s) {
      exec_.for_each(p_.n, DensityPass<Real, Lists, decltype(s)::value>{
                               p_, lists_, a_.position.data(), a_.density.data()});
    });
    density_is_current_ = true;
  }

  Exec& exec_;
  Params<Real> p_;
  KernelMode mode_;
  int iterations_, substeps_, more_rounds_;
  std::uint64_t residual_limit_;
  std::vector<Real> step_length_;  ///< of each sweep
  bool fused_, tensile_;
  bool density_is_current_ = false, lists_are_current_ = false;
  Lists lists_{};
  ParticleArrays<Real, Exec> a_;
};

}  // namespace pbf::inline PBF_VARIANT
