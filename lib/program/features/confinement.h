// Vorticity confinement, after the last substep of an update: one pass computes the curl in its own
// array, another applies the confinement.
#pragma once

#include "kernels/pass_vorticity.h"
#include "lib/program/as_types.h"
#include "lib/program/features/dissipation.h"
#include "lib/program/pass.h"

namespace pbf::program_module::field {
/// x, y, z: curl times its gain, 1/s; w: magnitude of the curl without the gain.
inline constexpr struct CurlRows : Vectors {
} curl{{"curl", per_padded_row, Life::pass, false,
        Shown{.quantity = "curl times its gain", .unit = "1/s", .sum = true, .axial = true}}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

inline constexpr const char* kLessConfinement = "lower vorticity.epsilon";

struct Curl {
  static constexpr PassText text{"curl", "vorticity", kLessConfinement};
  using Needs = pbf::Needs<Gathers<field::position, W::inverse_density>, Gathers<field::velocity>,
                           UsesLists, Writes<field::curl>>;
  template <class G>
  static void launch(const G& c) {
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.pairs(CurlPass<typename G::Real, typename G::Lists, decltype(d)::value>{
          c.p, c.lists(), c[field::position], c[field::velocity], c[field::curl]});
    });
  }
};

struct Confine {
  static constexpr PassText text{"confinement", "vorticity", kLessConfinement};
  using Needs = pbf::Needs<Gathers<field::position, W::inverse_density>, Gathers<field::curl>,
                           UsesLists, Updates<field::velocity>, Adds<field::dissipation>>;
  template <class G>
  static void launch(const G& c) {
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.pairs(VorticityPass<typename G::Real, typename G::Lists, decltype(d)::value>{
          c.p, c.lists(), c[field::position], c[field::curl], c[field::velocity],
          viscous_book<Dissipation::confinement>(c)});
    });
  }
};

struct VorticityConfinement {
  using Passes = PassList<Curl, Confine>;
  static void add(const Scene& s, auto& b) {
    if (!dissipates(s, Dissipation::confinement))
      return b.left_out("curl and confinement passes, curl array", "no key vorticity");
    b.after(Curl());
    b.after(Confine());
  }
};

}  // namespace pbf::PBF_VARIANT
