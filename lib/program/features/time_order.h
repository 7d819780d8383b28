// Time steps of second order (kernels/README.md, "Second order in time"). The predictions, the
// direction of corrections and the load of walls are in their own passes; what stands here is the
// change of the step length, of which the start of a run is one.
#pragma once

#include "kernels/pass_change_step.h"
#include "lib/program/features/loads.h"
#include "lib/program/motion.h"
#include "lib/program/time_order.h"

namespace pbf::program_module::field {
inline constexpr struct StepLengthRow : Plain<StepLength> {
} step_length{{kStepLengthField, one_row, Life::state}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

struct ChangeStep {
  static constexpr PassText text{"step length", "predict"};
  using Needs = pbf::Needs<
      If<is_second_order, Reads<field::position>, Updates<field::velocity>,
         Updates<field::free_velocity>, Looks<field::step_length>, Places<field::step_length>>,
      If<carries_loads, Updates<field::wall_pushes>>>;
  template <class G>
  static void launch(const G& c) {
    launch(c, {});
  }
  template <class G>
  static void launch(const G& c, const FrameStep<double>& tank) {
    const double dt = double(c.p.dt);
    c.items(ChangeStepPass<typename G::Real>{c.p, c[field::step_length], has_tank_motion(c.scene),
                                             tank, c[field::position], c[field::velocity],
                                             c[field::free_velocity]});
    if (carries_loads(c.scene))
      c.items(int(load_walls(c.scene)),
              ChangeWallPushPass{c[field::step_length], dt, c[field::wall_pushes].rows()});
    c.items(1, SetStepLengthPass{c[field::step_length], dt});
  }
};

struct StepLengths {
  using Passes = PassList<ChangeStep>;
  static void add(const Scene& s, auto& b) {
    if (is_second_order(s))
      b.reading(ChangeStep());
    else
      b.left_out("velocities without the last push", "time.order is 1");
  }

  template <class Real>
  struct Memory : NoMemory {
    bool due = true;  ///< whether the length of the last step may be another than that of the next

    template <class C>
    void forget(C&) {
      due = true;
    }
    template <class C>
    void before_steps(C& c, const StepRange& steps) {
      if (!due || !is_second_order(c.scene) || !(c.p.dt > 0)) return;
      due = false;
      FrameStep<double> tank;
      if (has_tank_motion(c.scene))
        tank = frame_step(c.scene, c.plan.axes, double(steps.first) * steps.dt, steps.dt);
      c.template as_pass<ChangeStep>([&](const auto& pass) { ChangeStep::launch(pass, tank); });
    }
  };
};

}  // namespace pbf::PBF_VARIANT
