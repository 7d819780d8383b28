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

  /// Positions and velocities are in the internal frame, in the order of ids 0..n-1. What comes out
  /// is along the scene's axes.
  Stepper(Exec& exec, const Params<Real>& params, KernelMode mode, int iterations, const Plan& plan,
          std::vector<Vec4<Real>> position, std::vector<Vec4<Real>> velocity, std::vector<int> id)
      : exec_(exec),
        p_(params),
        axes_(plan.axes),
        mode_(mode),
        iterations_(iterations),
        substeps_(plan.substeps),
        lists_per_update_(plan.lists_per_update),
        more_rounds_(plan.more_rounds),
        residual_limit_(residual_limit(plan.tolerance, params.n)),
        fused_(plan.fused),
        tensile_(plan.tensile) {
    for (int k = 0; k < iterations; ++k)
      sor_.push_back(
          Real(plan.sor * (plan.sweep_factors.empty() ? 1 : plan.sweep_factors[std::size_t(k)])));
    a_.make(exec_, p_, position, velocity, id);
    find_pairs();
    sum_density();
  }

  /// Updates (kernels/README.md, "The step"). Where only viscosity lies between a sweep and the
  /// next update, one pass does both that and the next bins.
  void step(int updates) {
    if (updates <= 0) return;
    exec_.begin();
    if (!has_pairs()) {
      for (int k = updates * substeps_; k > 0; --k) move();
      moved();
      return;
    }
    const auto unseen = [](const char*, int) {};
    bool moved_on = false;
    for (int left = updates - 1; left >= 0; --left) {
      SubstepRange r;
      while (next_range(r)) {
        if (!moved_on)
          with_dimensions(p_.dimensions, [&](auto d) {
            reorder<true>(kUpdateStages,
                          PredictPass<Real, decltype(d)::value>{p_, a_.position.data(),
                                                                a_.velocity.data(), a_.bin.data()});
          });
        moved_on = false;
        solve(r, unseen, true);
      }
      moved_on = left > 0 && p_.xsph > Real(0) && !(p_.vorticity > Real(0));
      if (moved_on)
        with_smoothing(mode_, p_.dimensions, [&](auto s) {
          reorder<true>({"xsph", "grid", "neighbors"}, xsph<decltype(s)::value, true>());
        });
      else
        finish_update(unseen);
    }
    moved();
  }

  /// One update, with what each stage left behind.
  StepTrace trace(const TraceOptions& options) {
    Tracer<Real, Exec> t(exec_, p_.n, axes_, options);
    step_seen([&](const char* stage, int sweep) { record(t, stage, sweep); });
    return t.result();
  }

  /// One update, looking at what each stage left behind and putting a fault in, where these are not
  /// null. `update`: its number, the first is 1.
  std::optional<StageEvent> step_checked(std::int64_t update, const StageLimits* limits,
                                         const Fault* fault) {
    StageCheck<Real, Exec> check(exec_, p_, axes_, update, limits, fault);
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

  int size() const { return p_.n; }

  /// Others differ in what goes with the time step.
  void set_params(const Params<Real>& p) { p_ = p; }

  /// The rest of the state stays empty.
  SolverState positions() {
    SolverState s;
    s.position = rows_by_id(exec_, axes_, std::size_t(p_.n), a_.position.data(), a_.id.data());
    return s;
  }
  SolverState state(std::int64_t updates, std::int64_t steps) {
    return download_state<Real>(exec_, std::size_t(p_.n), axes_, a_.state(), updates, steps);
  }

  /// Takes over a state of as many particles, in any order.
  void set_state(const SolverState& s) {
    upload_state<Real>(exec_, axes_, s, a_.state());
    moved();
  }

  /// Whether an update looks at pairs. Without sweeps, viscosity and vorticity it only moves
  /// particles, and lists are made where a measure or a download asks for the density.
  bool has_pairs() const { return iterations_ > 0 || p_.xsph > Real(0) || p_.vorticity > Real(0); }

  /// Makes lists at the present positions, where there are none, and says so. Those of the last
  /// update do not do: they name the pairs of its predicted positions, and a density summed over
  /// them misses every pair that has come nearer since. Rows are in the order of bin and id, so
  /// this sort changes no bit of the updates that follow.
  bool find_pairs() {
    if (lists_are_current_) return false;
    reorder_as_is({"measure", "measure", "measure"});
    return true;
  }

  /// Where the arrays of the state lie: updates that were recorded hold for one such place.
  int placement() const { return a_.placement(); }

  /// Sums at the present positions, over lists of their own.
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

  /// SI units, the scene's axes, id order, into device-visible buffers; null where not asked for.
  template <class Out>
  void export_to(double h, double rest_density, const Double3& origin, Out* position, Out* velocity,
                 Out* density) {
    exec_.begin();
    if (density) {
      find_pairs();
      sum_density();
    }
    const auto from = [&](int k) { return origin[std::size_t(axes_.of[k])]; };
    exec_.for_each(p_.n, ExportPass<Real, Out>{h,
                                               rest_density,
                                               {from(0), from(1), from(2)},
                                               axes_,
                                               a_.position.data(),
                                               a_.velocity.data(),
                                               a_.density.data(),
                                               a_.id.data(),
                                               position,
                                               velocity,
                                               density});
    exec_.mark("download");
  }

  /// The particles have moved, also by a replay of recorded updates (an even number of them):
  /// nothing that was summed or listed before holds.
  void moved() { density_is_current_ = lists_are_current_ = false; }

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
    moved();
  }
  SolverState state(Saved& s, std::int64_t updates, std::int64_t steps) {
    return download_state<Real>(exec_, std::size_t(p_.n), axes_, s.state(), updates, steps);
  }

  std::size_t bytes() const { return a_.bytes() + exec_.bytes(); }

 private:
  /// Names under which the parts of a sort with new lists are timed: the pass before it, the sort,
  /// the lists.
  struct SortStages {
    const char *first, *grid, *lists;
  };
  static constexpr SortStages kUpdateStages{"predict", "grid", "neighbors"};

  /// Substeps first..last-1 share their lists; range number `number` of the update.
  struct SubstepRange {
    int number = -1, first = 0, last = 0, sweeps = 0;
  };
  /// On to the next range of an update; false after the last one. The ranges are as equal as can
  /// be.
  bool next_range(SubstepRange& r) const {
    if (++r.number == lists_per_update_) return false;
    r.first = r.last;
    r.last = int(std::int64_t(substeps_) * (r.number + 1) / lists_per_update_);
    return true;
  }

  /// One update, one pass after the other: the bits of step(1). `seen(stage, sweep)` may look at
  /// what each stage left behind.
  template <class Seen>
  void step_seen(const Seen& seen) {
    exec_.begin();
    SubstepRange r;
    while (next_range(r)) {
      move();
      seen("predict", r.first);
      reorder_as_is(kUpdateStages);
      seen("grid", r.first);
      seen("neighbors", r.first);
      solve(r, seen, false);
    }
    finish_update(seen);
    moved();
  }

  /// Runs the pass that gives every particle its bin, sorts and gathers the particles by bin (as
  /// predicted, with `moving`), makes the lists.
  template <bool moving, class First>
  void reorder(const SortStages& stages, const First& first) {
    exec_.sort_by_bin(
        stages.first, first, p_.n, bin_count(p_), a_.id.data(), a_.sort_order(),
        a_.bin_start.data(),
        GatherPass<Real, moving>{p_, a_.position.data(), a_.velocity.data(), a_.id.data(),
                                 a_.other_position.data(), a_.other_velocity.data(),
                                 a_.other_id.data(), a_.counts.data()});
    a_.swap();
    exec_.mark(stages.grid);
    lists_ = exec_.build_lists(a_.position.data(), a_.bin_start.data(), p_);
    lists_are_current_ = true;
    exec_.mark(stages.lists);
  }

  /// x* and the velocity that goes with it, in place.
  void move() {
    exec_.for_each(p_.n,
                   MovePass<Real>{p_, a_.position.data(), a_.velocity.data(), a_.counts.data()});
    exec_.mark("predict");
  }

  /// The same with the positions as they are.
  void reorder_as_is(const SortStages& stages) {
    with_dimensions(p_.dimensions, [&](auto d) {
      reorder<false>(stages,
                     BinPass<Real, decltype(d)::value>{p_, a_.position.data(), a_.bin.data()});
    });
  }

  /// The sweeps of the first substep of a range, whose x* is there already, then its other substeps
  /// with the same lists. Rounds of sweeps go on while the mean compression that the last sweep
  /// found is above the tolerance. `seen(stage, sweep)` may look at what each stage left behind.
  /// With `joined`, the last sweep of a substep also takes the particles to the next one: the same
  /// arithmetic in one launch less.
  template <class Seen>
  void solve(SubstepRange& range, const Seen& seen, bool joined) {
    joined = joined && iterations_ > 0 && more_rounds_ == 0;
    for (int s = range.first; s < range.last; ++s) {
      if (s > range.first && !joined) {
        move();
        seen("predict", s);
      }
      with_smoothing(mode_, p_.dimensions, [&](auto smoothing) {
        const auto round = [&] {
          for (int k = 0; k < iterations_; ++k) {
            p_.sor = sor_[std::size_t(k)];
            const bool moves_on = joined && k == iterations_ - 1 && s < range.last - 1;
            sweep<decltype(smoothing)::value>(seen, ++range.sweeps, moves_on);
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
      exec_.for_each(p_.n, LambdaPass<Real, Lists, S, decltype(fused)::value>{
                               p_, lists_, a_.position.data(), a_.other_position.data(),
                               a_.density.data(), a_.velocity.data(), a_.counts.data()});
    });
    exec_.mark("lambda");
    seen("lambda", number);
    with_bool(tensile_, [&](auto tensile) {
      exec_.for_each(
          p_.n, DeltaPass<Real, Lists, S, decltype(tensile)::value>{
                    p_, lists_, a_.other_position.data(), a_.density.data(), a_.id.data(),
                    a_.position.data(), a_.velocity.data(), moves_on ? a_.counts.data() : nullptr});
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
    a_.swap_velocity();
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
  Axes axes_;
  KernelMode mode_;
  int iterations_, substeps_, lists_per_update_, more_rounds_;
  std::uint64_t residual_limit_;
  std::vector<Real> sor_;  ///< of each sweep
  bool fused_, tensile_;
  bool density_is_current_ = false, lists_are_current_ = false;
  Lists lists_{};
  ParticleArrays<Real, Exec> a_;
};

}  // namespace pbf::inline PBF_VARIANT
