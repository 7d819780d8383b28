// Hyperviscosity, between updates.
#pragma once

#include "kernels/pass_hyperviscosity.h"
#include "lib/program/as_types.h"
#include "lib/program/features/dissipation.h"
#include "lib/program/hyperviscosity.h"
#include "lib/program/pass.h"

namespace pbf::program_module::field {
inline constexpr struct VelocityLaplacianRows : Vectors {
} velocity_laplacian{{"velocity laplacian", per_padded_row, Life::pass, false,
                      Shown{.quantity = "laplacian of the velocity", .unit = "h/s", .sum = true}}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

inline constexpr const char* kLessHyperviscosity = "lower solver.hyperviscosity";

struct VelocityLaplacian {
  static constexpr PassText text{"velocity laplacian", "hyperviscosity", kLessHyperviscosity};
  using Needs = pbf::Needs<Gathers<field::position>, Gathers<field::velocity>, UsesLists,
                           Writes<field::velocity_laplacian>>;
  template <class G>
  static void launch(const G& c) {
    c.with_smoothing([&](auto s) {
      c.pairs(VelocityLaplacianPass<typename G::Real, typename G::Lists, decltype(s)::value>{
          {c.p, c.lists(), c[field::position], c[field::velocity]}, c[field::velocity_laplacian]});
    });
  }
};

struct Hyperviscous {
  static constexpr PassText text{"hyperviscosity", "hyperviscosity", kLessHyperviscosity};
  using Needs = pbf::Needs<Gathers<field::position>, Gathers<field::velocity_laplacian>, UsesLists,
                           Updates<field::velocity>, Adds<field::dissipation>>;
  template <class G>
  static void launch(const G& c) {
    c.with_smoothing([&](auto s) {
      c.pairs(HyperviscosityPass<typename G::Real, typename G::Lists, decltype(s)::value>{
          {c.p, c.lists(), c[field::position], c[field::velocity_laplacian]},
          c[field::velocity],
          viscous_book<Dissipation::hyperviscosity>(c)});
    });
  }
};

struct Hyperviscosities {
  using Passes = PassList<VelocityLaplacian, Hyperviscous>;
  static void add(const Scene& s, auto& b) {
    const Hyperviscosity h = hyperviscosity_of(s);
    if (h.every == 0)
      return b.left_out("passes of hyperviscosity, its array",
                        s.solver.iterations == 0  ? "solver.iterations is 0"
                        : gravity_of(s) == 0      ? "gravity is 0"
                        : s.solver.hyperviscosity ? "solver.hyperviscosity is 0"
                                                  : "time.order is 1");
    b.every(h.every, VelocityLaplacian());
    b.every(h.every, Hyperviscous());
  }
};

}  // namespace pbf::PBF_VARIANT
