// Checks the results of every stage of one update on the host. Slow, because it copies the whole
// state after each stage. Used for updates that the guard repeats and for tests that inject faults.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "kernels/axes.h"
#include "kernels/params.h"
#include "lib/program/pass.h"
#include "lib/solver/stage_event.h"
#include "lib/solver/step_context.h"
#include "lib/solver/tracer.h"

namespace pbf::PBF_VARIANT {

/// Context: a StepContext.
template <class Context>
class StageCheck {
 public:
  using Real = typename Context::Real;
  /// Null for `limits`: no checks. Null for `fault`: nothing is injected.
  StageCheck(Context& c, const Axes& axes, std::int64_t update, const StageLimits* limits,
             const Fault* fault)
      : c_(c), p_(c.p), axes_(axes), update_(update), limits_(limits), fault_(fault) {}

  void look(const PassInfo& pass, int iteration) {
    if (event_) return;
    const Arrays a = arrays(pass);
    if (fault_ && fault_->update == update_ && fault_->stage == pass.stage &&
        fault_->iteration == iteration)
      inject(a);
    if (limits_) check(pass, iteration, a);
  }
  const std::optional<StageEvent>& event() const { return event_; }

 private:
  /// The arrays to check after a pass.
  struct Arrays {
    Vec4<Real>* position;            ///< w: a result of the pass (lambda, 1/density)
    Real* density = nullptr;         ///< null: not the main result of the pass
    bool stores_fourth = false;      ///< whether the main result is w of the position
    const int* neighbors = nullptr;  ///< lengths of new lists; null: the lists are not new
  };
  Arrays arrays(const PassInfo& pass) {
    Arrays a{c_.position()};
    if (pass.stored >= 0) {
      const Written& w = pass.written[std::size_t(pass.stored)];
      if (w.part == Written::scalar) a.density = c_.template data<Real>(*w.field);
      a.stores_fourth = w.part == Written::fourth;
      if (a.stores_fourth) a.position = c_.template data<Vec4<Real>>(*w.field);
    }
    if (pass.makes_lists()) {
      int* free = c_.template data<int>(other<field::id>);  // unused until the next sort
      c_.exec.items(c_.rows(), ListSizePass<typename Context::Lists>{c_.lists, free});
      a.neighbors = free;
    }
    return a;
  }

  template <class T>
  std::vector<T> host(const T* from) {
    std::vector<T> v(std::size_t(c_.host_rows()));
    if (from) c_.exec.to_host(from, v.size(), v.data());
    return v;
  }

  void inject(const Arrays& a) {
    const std::vector<int> id = host(c_.ids());
    for (std::size_t k = 0; k < id.size(); ++k) {
      if (id[k] != fault_->id) continue;
      const Real value = Real(fault_->value);
      if (!is_finite(value) && a.density) {
        c_.exec.to_device(&value, 1, a.density + k);
        return;
      }
      const bool fourth = !is_finite(value) && a.stores_fourth;
      Vec4<Real>* at = (fourth ? a.position : c_.velocity()) + k;
      Vec4<Real> x;
      c_.exec.to_host(at, 1, &x);
      (fourth ? x.w : (&x.x)[axes_.inside(0)]) = value;
      c_.exec.to_device(&x, 1, at);
      return;
    }
  }

  void check(const PassInfo& pass, int iteration, const Arrays& a) {
    const auto x = host<Vec4<Real>>(a.position), v = host<Vec4<Real>>(c_.velocity());
    const auto density = host<Real>(a.density);
    const auto id = host<int>(c_.ids()), neighbors = host<int>(a.neighbors);
    // In second order, lambda leaves places between those of two stages. They are inside but for
    // rounding, and no particle moves there.
    const bool between = p_.back > Real(0) && pass.leaves(W::lambda);
    double energy = 0, fastest = -1;
    std::size_t fast = 0;
    const auto found = [&](Alarm alarm, std::size_t k, double value) {
      if (event_ && event_->id < id[k]) return;
      event_ = StageEvent{alarm, update_, pass.stage, pass.remedy, iteration, id[k], {}, {}, value};
      for (int c = 0; c < 3; ++c) {
        event_->position[axes_.of[c]] = double((&x[k].x)[c]);
        event_->velocity[axes_.of[c]] = double((&v[k].x)[c]);
      }
    };
    for (std::size_t k = 0; k < id.size(); ++k) {
      if (is_image(id[k])) continue;
      const double values[] = {double(x[k].x), double(x[k].y), double(x[k].z), double(x[k].w),
                               double(v[k].x), double(v[k].y), double(v[k].z), double(density[k])};
      bool finite = true;
      for (const double value : values) {
        if (is_finite(value)) continue;
        found(Alarm::non_finite, k, value);
        finite = false;
        break;
      }
      const double speed =
          std::sqrt(values[4] * values[4] + values[5] * values[5] + values[6] * values[6]);
      // As in a measurement, a speed whose square overflows counts as not finite.
      if (finite && !is_finite(dot(xyz(v[k]), xyz(v[k]))))
        found(Alarm::non_finite, k, speed), finite = false;
      if (!finite) continue;
      if (!between && p_.boundary.beyond({values[0], values[1], values[2]}))
        found(Alarm::outside, k, speed);
      if (speed > limits_->speed) found(Alarm::speed, k, speed);
      if (a.neighbors && neighbors[k] > limits_->neighbors)
        found(Alarm::neighbors, k, neighbors[k]);
      energy += 0.5 * speed * speed - double(p_.gravity.x) * values[0] -
                double(p_.gravity.y) * values[1] - double(p_.gravity.z) * values[2];
      if (speed > fastest) fastest = speed, fast = k;
    }
    if (!event_ && energy > limits_->energy) found(Alarm::energy, fast, energy);
  }

  Context& c_;
  const Params<Real>& p_;
  Axes axes_;
  std::int64_t update_;
  const StageLimits* limits_;
  const Fault* fault_;
  std::optional<StageEvent> event_;
};

}  // namespace pbf::PBF_VARIANT
