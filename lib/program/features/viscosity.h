// XSPH viscosity, after the last substep of an update.
#pragma once

#include "kernels/pass_xsph.h"
#include "lib/program/features/motion.h"

namespace pbf::PBF_VARIANT {

inline constexpr const char* kLessXsph = "lower viscosity.xsph";

/// Calls use() with the pass that reads `velocity` and writes `velocity_out`. bin: array for
/// the particles' bins in the next update, or null. free: field::free_velocity, with bin.
template <class G, class Rows, class Use>
void with_xsph(const G& c, GatheredRows<Rows> position, GatheredRows<Rows> velocity,
               OwnRows<Rows> velocity_out, std::type_identity_t<Rows>* free, int* bin,
               const Use& use) {
  using Real = typename G::Real;
  c.with_smoothing([&](auto s) {
    const DissipationBook damping = bin ? damping_book(c) : DissipationBook{};
    with_order<decltype(s)::value, Real>(c.scene, free, damping, [&](const auto& order) {
      with_far_boundary(c, [&](const auto& boundary) {
        use(XsphPass<Real, typename G::Lists, decltype(s)::value, std::decay_t<decltype(order)>,
                     std::decay_t<decltype(boundary)>>{
            c.p, boundary, c.lists(), position, velocity, velocity_out, bin,
            viscous_book<Dissipation::viscosity>(c), order});
      });
    });
  });
}

struct Xsph {
  static constexpr PassText text{"xsph", "xsph", kLessXsph};
  using Flips = pbf::Flips<field::velocity>;
  using Needs =
      pbf::Needs<Gathers<field::position, W::inverse_density>, Gathers<other<field::velocity>>,
                 UsesLists, Writes<field::velocity>, Adds<field::dissipation>>;
  static void launch(const auto& c) {
    with_xsph(c, c[field::position], c[other<field::velocity>], c[field::velocity], nullptr,
              nullptr, [&](const auto& pass) { c.pairs(pass); });
  }
};

/// Xsph writes the velocities into the second array, and the sort gathers them back into the first.
struct XsphPredictSort {
  using Fuses = Pair<Xsph, PredictSort>;
  static constexpr PassText text{"xsph+predict+sort", "grid", kLessXsph};
  using Flips = pbf::Flips<field::position, field::free_velocity, field::id>;
  using Needs = pbf::Needs<Gathers<other<field::position>, W::inverse_density>, SortPredictedNeeds,
                           Gathers<field::velocity>, UsesLists, Places<other<field::velocity>>,
                           Adds<field::dissipation>>;
  template <class G>
  static void launch(const G& c) {
    using Rows = Vec4<typename G::Real>;
    Rows *position = c[other<field::position>], *from = c[field::velocity],
         *to = c[other<field::velocity>];
    with_xsph(c, GatheredRows<Rows>(position), GatheredRows<Rows>(from), OwnRows<Rows>(to),
              c.declared(other<field::free_velocity>), c[field::bin].rows(),
              [&](const auto& pass) { sort_predicted(c, "xsph", pass, to, from); });
  }
};

struct XsphViscosity {
  using Passes = PassList<Xsph, XsphPredictSort>;
  static void add(const Scene& s, auto& b) {
    if (dissipates(s, Dissipation::viscosity))
      b.after(Xsph());
    else
      b.left_out("xsph pass", "no key viscosity");
  }
};

}  // namespace pbf::PBF_VARIANT
