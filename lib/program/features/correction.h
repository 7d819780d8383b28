// The position correction of one iteration, including the artificial pressure and the displacement
// by the levels.
#pragma once

#include "kernels/pass_delta.h"
#include "lib/program/features/levels.h"
#include "lib/program/features/motion.h"

namespace pbf::inline PBF_VARIANT {

template <class C>
void launch_delta(C& c, StepCounts* moves_on) {
  auto p = c.p;
  p.sor = c.sor();
  c.with_smoothing([&](auto s) {
    with_bool(c.scene.tensile && c.scene.tensile->k != 0, [&](auto tensile) {
      with_level_move(c, [&](const auto& coarse) {
        each_then_near<true>(c, [&](const auto& boundary) {
          return DeltaPass<typename C::Real, typename C::Lists, decltype(s)::value,
                           decltype(tensile)::value, std::decay_t<decltype(coarse)>,
                           std::decay_t<decltype(boundary)>>{
              p,           boundary, c.lists,      c.other(field::position),
              c.density(), c.ids(),  c.position(), c.velocity(),
              moves_on,    coarse};
        });
      });
    });
  });
}
inline PassInfo delta_info(const char* name) {
  return {name,
          "delta",
          {other(field::position), {&field::lists}, {&field::density}, {&field::velocity}},
          {vector({&field::position}, "position", "h"),
           {{&field::position}, Written::fourth, "1/density", "1/rho0"},
           vector({&field::velocity}, "velocity", "h/s")},
          DeltaPass<float, ChunkedLists, Smoothing::consistent, true, NoLevelMove<float>,
                    Box<float>>::gathers};
}

struct Delta {
  static PassInfo info() { return delta_info("delta"); }
  template <class C>
  static void launch(C& c) {
    launch_delta(c, nullptr);
  }
};

/// Takes the particles to the next substep as well: the same arithmetic in one launch less.
struct DeltaPredict {
  using Fuses = Pair<Delta, Predict>;
  static PassInfo info() { return delta_info("delta+predict"); }
  template <class C>
  static void launch(C& c) {
    launch_delta(c, c.counts());
  }
};

struct Correction {
  using Passes = PassList<Delta, DeltaPredict>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (s.solver.iterations == 0) return;
    b.template iteration<Delta>();
    if (!s.tensile || s.tensile->k == 0)
      b.left_out("artificial pressure in the delta loop", "no key tensile");
  }
};

}  // namespace pbf::inline PBF_VARIANT
