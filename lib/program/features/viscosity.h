// XSPH viscosity, after the last substep of an update.
#pragma once

#include "kernels/pass_xsph.h"
#include "lib/program/features/motion.h"

namespace pbf::inline PBF_VARIANT {

inline constexpr const char* kLessXsph = "lower viscosity.xsph";

/// use(the pass from velocities into others). bin: null, or where the particles' bins in the next
/// update go.
template <class G, class Vectors, class Use>
void with_xsph(const G& c, const Vectors* velocity, Vectors* velocity_out, int* bin,
               const Use& use) {
  c.with_smoothing([&](auto s) {
    with_far_boundary(c.context(), [&](const auto& boundary) {
      use(XsphPass<typename G::Real, typename G::Lists, decltype(s)::value,
                   std::decay_t<decltype(boundary)>>{c.p, boundary, c.lists(),
                                                     c.context().position(), velocity, velocity_out,
                                                     bin});
    });
  });
}

struct Xsph {
  static constexpr PassText text{"xsph", "xsph", kLessXsph};
  using Flips = pbf::Flips<field::velocity>;
  using Needs = pbf::Needs<Gathers<field::position, W::inverse_density>,
                           Gathers<other<field::velocity>>, UsesLists, Writes<field::velocity>>;
  template <class G>
  static void launch(const G& c) {
    with_xsph(c, c[other<field::velocity>].rows(), c[field::velocity].rows(), nullptr,
              [&](const auto& pass) { c.each(pass); });
  }
};

/// The velocities go into the other array, and the sort takes them back.
struct XsphPredictSort {
  using Fuses = Pair<Xsph, PredictSort>;
  static constexpr PassText text{"xsph+predict+sort", "xsph", kLessXsph};
  using Flips = pbf::Flips<field::position, field::id>;
  using Needs = pbf::Needs<Gathers<other<field::position>, W::inverse_density>,
                           SortPredictedNeeds, Gathers<field::velocity>, UsesLists,
                           Writes<other<field::velocity>>>;
  template <class G>
  static void launch(const G& c) {
    auto& parts = c.context();
    auto *from = parts.velocity(), *to = parts.second_velocity();
    with_xsph(c, from, to, c[field::bin],
              [&](const auto& pass) { sort_predicted(c, "xsph", pass, to, from); });
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
