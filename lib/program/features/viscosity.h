// XSPH viscosity, after the last substep of an update.
#pragma once

#include "kernels/pass_xsph.h"
#include "lib/program/features/motion.h"

namespace pbf::inline PBF_VARIANT {

/// The velocities come out in the other array, and the arrays trade places. bin: null, or where the
/// particles' bins in the next update go.
template <class C, class Use>
void with_xsph(C& c, int* bin, const Use& use) {
  c.flip(field::velocity);
  c.with_smoothing([&](auto s) {
    with_far_boundary(c, [&](const auto& boundary) {
      use(XsphPass<typename C::Real, typename C::Lists, decltype(s)::value,
                   std::decay_t<decltype(boundary)>>{c.p, boundary, c.lists, c.position(),
                                                     c.other(field::velocity), c.velocity(), bin});
    });
  });
}
inline PassInfo xsph_info(PassInfo writes, const char* name) {
  writes.name = name;
  writes.reads = {{&field::position}, {&field::velocity}, {&field::lists}};
  writes.gathers = XsphPass<float, ChunkedLists, Smoothing::consistent, Box<float>>::gathers;
  writes.remedy = "lower viscosity.xsph";
  return writes;
}

struct Xsph {
  static PassInfo info() {
    return xsph_info({"", "xsph", {}, {vector({&field::velocity}, "velocity", "h/s")}}, "xsph");
  }
  template <class C>
  static void launch(C& c) {
    with_xsph(c, nullptr, [&](const auto& pass) { c.pairs(pass); });
  }
};

struct XsphPredictSort {
  using Fuses = Pair<Xsph, PredictSort>;
  static PassInfo info() { return xsph_info(sort_info(""), "xsph+predict+sort"); }
  template <class C>
  static void launch(C& c) {
    with_xsph(c, c.template data<int>(field::bin),
              [&](const auto& pass) { sort_predicted(c, "xsph", pass); });
  }
};

struct XsphViscosity {
  using Passes = PassList<Xsph, XsphPredictSort>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (s.viscosity && s.viscosity->xsph != 0)
      b.template after<Xsph>();
    else
      b.left_out("xsph pass", "no key viscosity");
  }
};

}  // namespace pbf::inline PBF_VARIANT
