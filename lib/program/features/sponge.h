// Sponges, between updates: zones in which velocities decay.
#pragma once

#include "lib/program/features/dissipation.h"
#include "lib/program/features/motion.h"
#include "lib/program/pass.h"
#include "lib/program/sponges.h"

namespace pbf::PBF_VARIANT {

struct Damp {
  static constexpr PassText text{"sponge", "predict", "lower the rate of damping"};
  using Needs =
      pbf::Needs<Reads<field::position>, Updates<field::velocity>,
                 If<is_second_order, Updates<field::free_velocity>>, Adds<field::dissipation>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    SpongePass<Real> pass{{},
                          int(c.scene.damping.size()),
                          c.p.update_dt,
                          c[field::position],
                          c[field::velocity],
                          c.declared(field::free_velocity),
                          dissipation_book<Dissipation::sponge>(c)};
    for (std::size_t k = 0; k < c.scene.damping.size(); ++k)
      pass.zone[k] = sponge_zone<Real>(c.scene, c.plan.axes, k);
    c.items(pass);
  }
};

struct Sponges {
  using Passes = PassList<Damp>;
  static void add(const Scene& s, auto& b) {
    if (s.damping.empty()) return b.left_out("sponge pass", "no key damping");
    b.after(Damp());
  }
};

}  // namespace pbf::PBF_VARIANT
