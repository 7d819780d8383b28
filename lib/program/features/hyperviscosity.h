// Hyperviscosity, between updates.
#pragma once

#include "kernels/pass_packed_hyperviscosity.h"
#include "lib/program/as_types.h"
#include "lib/program/features/viscosity.h"
#include "lib/program/hyperviscosity.h"
#include "lib/program/pass.h"

namespace pbf::program_module::field {
inline constexpr struct VelocityLaplacianRows : Vectors {
} velocity_laplacian{{"velocity laplacian", per_padded_row, Life::pass, false,
                      Shown{.quantity = "laplacian of the velocity", .unit = "h/s", .sum = true}}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

inline constexpr const char* kLessHyperviscosity = "lower solver.hyperviscosity";

struct PackForHyperviscosity : PackMotion {
  static constexpr PassText text{"hyperviscosity: pack motion", "hyperviscosity",
                                 kLessHyperviscosity};
};

struct VelocityLaplacian {
  static constexpr PassText text{"velocity laplacian", "hyperviscosity", kLessHyperviscosity};
  using Needs = pbf::Needs<
      If<is_not_packed, Gathers<field::position>, Gathers<field::velocity>,
         Writes<field::velocity_laplacian>>,
      If<is_packed, Reads<field::position>,
         PackedMotion<Gathers<other<field::free_velocity>>, Gathers<other<field::position>>>,
         Writes<other<field::velocity>>>,
      UsesLists>;
  template <class G>
  static void launch(const G& c) {
    c.with_smoothing([&](auto s) {
      constexpr Smoothing S = decltype(s)::value;
      using Real = typename G::Real;
      if constexpr (has_packed_rows<G> && S == Smoothing::consistent)
        if (c.plan.packed) {
          const Vec4<Real>* motion =
              motion_rows(c, other<field::free_velocity>, other<field::position>);
          return c.pairs(PackedVelocityLaplacianPass<typename G::Lists, S>{
              {c.p, c.lists(), GatheredRows<Vec4<Real>>(motion)},
              c[field::position],
              c[other<field::velocity>]});
        }
      c.pairs(VelocityLaplacianPass<Real, typename G::Lists, S>{
          {c.p, c.lists(), c[field::position], c[field::velocity]}, c[field::velocity_laplacian]});
    });
  }
};

struct Hyperviscous {
  static constexpr PassText text{"hyperviscosity", "hyperviscosity", kLessHyperviscosity};
  using Needs =
      pbf::Needs<If<is_not_packed, Gathers<field::position>, Gathers<field::velocity_laplacian>>,
                 If<is_packed, Gathers<other<field::velocity>>>, UsesLists,
                 Updates<field::velocity>, Adds<field::dissipation>>;
  template <class G>
  static void launch(const G& c) {
    c.with_smoothing([&](auto s) {
      constexpr Smoothing S = decltype(s)::value;
      using Real = typename G::Real;
      const DissipationBook book = viscous_book<Dissipation::hyperviscosity>(c);
      if constexpr (has_packed_rows<G> && S == Smoothing::consistent)
        if (c.plan.packed)
          return c.pairs(PackedHyperviscosityPass<typename G::Lists, S>{
              {c.p, c.lists(), c[other<field::velocity>]}, c[field::velocity], book});
      c.pairs(HyperviscosityPass<Real, typename G::Lists, S>{
          {c.p, c.lists(), c[field::position], c[field::velocity_laplacian]},
          c[field::velocity],
          book});
    });
  }
};

struct Hyperviscosities {
  using Passes = PassList<PackForHyperviscosity, VelocityLaplacian, Hyperviscous>;
  static void add(const Scene& s, auto& b) {
    const Hyperviscosity h = hyperviscosity_of(s);
    if (h.every == 0)
      return b.left_out("passes of hyperviscosity, its array",
                        s.solver.iterations == 0  ? "solver.iterations is 0"
                        : gravity_of(s) == 0      ? "gravity is 0"
                        : s.solver.hyperviscosity ? "solver.hyperviscosity is 0"
                                                  : "time.order is 1");
    if (b.shape.packed) b.every(h.every, PackForHyperviscosity());
    b.every(h.every, VelocityLaplacian());
    b.every(h.every, Hyperviscous());
  }
};

}  // namespace pbf::PBF_VARIANT
