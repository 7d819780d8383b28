// Looks, on the host, at what each stage of one update left behind. Slow: the whole state is copied
// after every stage; for the few updates that the guard repeats, and for faults put in by tests.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "kernels/axes.h"
#include "kernels/params.h"
#include "lib/solver/stage_event.h"

namespace pbf::inline PBF_VARIANT {

/// The arrays of a stage, in device-visible memory; row k belongs to particle id[k].
template <class Real>
struct StageArrays {
  Vec4<Real>*position, *velocity;  ///< position's w: what the stage put there (lambda, 1/density)
  Real* density;                   ///< null: not written by the stage
  const int* id;
  const int* neighbors;  ///< null: the lists are not new
};

template <class Real, class Exec>
class StageCheck {
 public:
  /// limits or fault may be null: then nothing is looked at, or nothing put in.
  StageCheck(Exec& exec, const Params<Real>& p, const Axes& axes, std::int64_t update,
             const StageLimits* limits, const Fault* fault)
      : exec_(exec), p_(p), axes_(axes), update_(update), limits_(limits), fault_(fault) {}

  void look(const std::string& stage, int sweep, const StageArrays<Real>& a) {
    if (event_) return;
    if (fault_ && fault_->update == update_ && fault_->stage == stage && fault_->sweep == sweep)
      inject(stage, a);
    if (limits_) check(stage, sweep, a);
  }
  const std::optional<StageEvent>& event() const { return event_; }

 private:
  template <class T>
  std::vector<T> host(const T* from) {
    std::vector<T> v(std::size_t(p_.n));
    if (from) exec_.to_host(from, v.size(), v.data());
    return v;
  }

  void inject(const std::string& stage, const StageArrays<Real>& a) {
    const std::vector<int> id = host(a.id);
    for (std::size_t k = 0; k < id.size(); ++k) {
      if (id[k] != fault_->id) continue;
      const Real value = Real(fault_->value);
      if (!is_finite(value) && a.density) {
        exec_.to_device(&value, 1, a.density + k);
        return;
      }
      const bool lambda = !is_finite(value) && stage == "lambda";
      Vec4<Real>* at = (lambda ? a.position : a.velocity) + k;
      Vec4<Real> x;
      exec_.to_host(at, 1, &x);
      (lambda ? x.w : (&x.x)[axes_.inside(0)]) = value;
      exec_.to_device(&x, 1, at);
      return;
    }
  }

  void check(const std::string& stage, int sweep, const StageArrays<Real>& a) {
    const auto x = host<Vec4<Real>>(a.position), v = host<Vec4<Real>>(a.velocity);
    const auto density = host<Real>(a.density);
    const auto id = host<int>(a.id), neighbors = host<int>(a.neighbors);
    double energy = 0, fastest = -1;
    std::size_t fast = 0;
    const auto found = [&](Alarm alarm, std::size_t k, double value) {
      if (event_ && event_->id < id[k]) return;
      event_ = StageEvent{alarm, update_, stage, sweep, id[k], {}, {}, value};
      for (int c = 0; c < 3; ++c) {
        event_->position[axes_.of[c]] = double((&x[k].x)[c]);
        event_->velocity[axes_.of[c]] = double((&v[k].x)[c]);
      }
    };
    for (std::size_t k = 0; k < id.size(); ++k) {
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
      // A measure takes a speed whose square overflows for no number as well.
      if (finite && !is_finite(dot(xyz(v[k]), xyz(v[k]))))
        found(Alarm::non_finite, k, speed), finite = false;
      if (!finite) continue;
      if (is_outside(x[k])) found(Alarm::outside, k, speed);
      if (speed > limits_->speed) found(Alarm::speed, k, speed);
      if (a.neighbors && neighbors[k] > limits_->neighbors)
        found(Alarm::neighbors, k, neighbors[k]);
      energy += 0.5 * speed * speed - double(p_.gravity.x) * values[0] -
                double(p_.gravity.y) * values[1] - double(p_.gravity.z) * values[2];
      if (speed > fastest) fastest = speed, fast = k;
    }
    if (!event_ && energy > limits_->energy) found(Alarm::energy, fast, energy);
  }

  bool is_outside(const Vec4<Real>& x) const {
    return (wall(x_min) && x.x < 0) || (wall(x_max) && x.x > p_.box.x) ||
           (wall(y_min) && x.y < 0) || (wall(y_max) && x.y > p_.box.y) ||
           (wall(z_min) && x.z < 0) || (wall(z_max) && x.z > p_.box.z);
  }
  bool wall(WallBit bit) const { return (p_.walls & bit) != 0; }

  Exec& exec_;
  const Params<Real>& p_;
  Axes axes_;
  std::int64_t update_;
  const StageLimits* limits_;
  const Fault* fault_;
  std::optional<StageEvent> event_;
};

}  // namespace pbf::inline PBF_VARIANT
