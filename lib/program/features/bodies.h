// Bodies that the fluid moves (kernels/README.md, "Free bodies").
#pragma once

#include "kernels/pass_bodies.h"
#include "lib/program/features/body_rows.h"
#include "lib/program/features/solids.h"

namespace pbf::PBF_VARIANT {

struct FreeBodies;

/// The needs of a pass that takes what bodies are owed.
using BodyNeeds =
    Needs<Looks<field::body_kinds>, Looks<field::body_states>, Places<field::body_states>,
          Looks<field::body_steps>, Places<field::body_steps>, Looks<field::load_sums>,
          If<carries_loads, Looks<field::clamp_sums>>, Looks<field::sharers>,
          Places<field::sharers>, Places<field::body_shares>>;

template <class G>
BodyRows<typename G::Real> body_rows(const G& c) {
  return {c[field::body_kinds],
          c[field::body_states],
          c[field::body_steps],
          int(free_bodies(c.scene)),
          double(c.p.dt),
          double(c.p.inv_dt) / double(kLoadUnits),
          moment_unit(c.p.boundary),
          c[field::load_sums],
          c.declared(field::clamp_sums),
          c[field::sharers],
          c.declared(field::solids),
          c.declared(field::solids_before),
          c.declared(field::solid_velocity),
          c.declared(field::body_shares)};
}
template <class G>
Vec3<double> gravity_of(const G& c) {
  return {double(c.p.gravity.x), double(c.p.gravity.y), double(c.p.gravity.z)};
}

/// Before each substep, when obstacles with a prescribed motion have been put at their places.
struct MoveBodies {
  static constexpr PassText text{"free bodies", "predict"};
  using Needs = pbf::Needs<BodyNeeds, Looks<field::solids>, Places<field::solids>,
                           Looks<field::solids_before>, Places<field::solids_before>,
                           Looks<field::solid_velocity>, Places<field::solid_velocity>,
                           Looks<field::contact_spots>, Looks<field::solid_spots>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    const BodyRows<Real> rows = body_rows(c);
    ContactScene<Real> contacts;
    contacts.body = rows.kind, contacts.state = rows.state;
    contacts.spot = c[field::contact_spots], contacts.solid = c[field::solid_spots];
    contacts.placed = rows.placed, contacts.before = rows.before;
    contacts.velocity = rows.velocity;
    contacts.solids = int(c.scene.obstacles.size() + c.scene.emitters.size());
    contacts.walls = c.p.boundary, contacts.flat = c.p.dimensions == 2;
    const Vec3<double> gravity = gravity_of(c);
    c.items(rows.bodies, StartBodiesPass<Real>{rows, contacts, gravity});
    const Real range = Real(1) / c.p.boundary.inv_range + Real(kNearRoom);
    c.items(1, PredictBodiesPass<Real>{rows, range, square_root(dot(gravity, gravity))});
  }
};

/// Behind it, before particles move.
struct CountSharers {
  static constexpr PassText text{"sharers of bodies", "predict"};
  using Needs =
      pbf::Needs<Reads<field::position>, Reads<field::velocity>, Looks<field::near_row>,
                 Looks<field::near_count>, SolidNeeds, ShareNeeds, Looks<field::body_kinds>,
                 Looks<field::body_states>, Places<field::body_states>, Looks<field::sharers>,
                 Places<field::sharers>, Places<field::body_shares>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    c.listed(c[field::near_count],
             CountSharersPass<Real>{solids_of(c), c[field::position], c[field::velocity], c.p.dt});
    BodyRows<Real> rows{};
    rows.kind = c[field::body_kinds], rows.state = c[field::body_states];
    rows.sharers = c[field::sharers], rows.share = c[field::body_shares];
    c.items(int(free_bodies(c.scene)), TakeSharersPass<Real>{rows});
  }
};

/// At the start of each iteration.
struct FollowFluid {
  static constexpr PassText text{"follow fluid", "delta"};
  using Needs = pbf::Needs<BodyNeeds, Places<field::solids>, Places<field::solid_velocity>>;
  template <class G>
  static void launch(const G& c) {
    if (c.p.dt > 0) c.items(1, FollowFluidPass<typename G::Real>{body_rows(c)});
  }
};

struct EndBodies {
  static constexpr PassText text{"energy of bodies", "measure"};
  using Needs = pbf::Needs<BodyNeeds, Looks<field::loads>, Places<field::loads>>;
  template <class G>
  static void launch(const G& c) {
    c.items(int(free_bodies(c.scene)),
            EndBodiesPass<typename G::Real>{body_rows(c), gravity_of(c), c[field::loads]});
  }
};

struct FreeBodies {
  using Passes = PassList<MoveBodies, CountSharers, FollowFluid, EndBodies>;
  static void add(const Scene& s, auto& b) {
    if (!has_free_bodies(s)) {
      if (!s.obstacles.empty()) b.left_out("free bodies", "no obstacle is free");
      return;
    }
    b.start(MoveBodies());
    b.start(CountSharers());
    if (s.solver.iterations > 0) b.iteration(FollowFluid());
    b.end(EndBodies());
  }

  template <class Real>
  struct Memory : NoMemory {
    template <class C>
    void make(C& c) {
      if (!has_free_bodies(c.scene)) return;
      const std::vector<BodyKind> kinds = body_kinds(c.scene, c.plan);
      c.put(field::body_kinds, kinds);
      c.put(field::body_steps, std::vector<BodyStep>(kinds.size()));
      c.put(field::body_shares, std::vector<BodyShare>(std::size_t(c.rows_of(field::body_shares))));
      c.put(field::body_states, first_bodies(c.scene, c.plan, kinds));
      const Spots spots = contact_spots(
          c.scene, c.plan, std::size_t(c.rows_of(field::solid_spots)) - c.scene.obstacles.size());
      c.put(field::contact_spots, spots.all);
      c.put(field::solid_spots, spots.of_solid);
    }
    void stand(auto& c, double) {
      if (!has_free_bodies(c.scene)) return;
      c.template as_pass<MoveBodies>([&](const auto& pass) {
        const BodyRows<Real> rows = body_rows(pass);
        pass.items(rows.bodies,
                   PlaceBodiesPass<Real>{rows.kind, rows.state, rows.placed, rows.before});
      });
    }
  };
};

}  // namespace pbf::PBF_VARIANT
