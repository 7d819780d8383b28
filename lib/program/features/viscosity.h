// Viscosity, after the last substep of an update: sweeps of XSPH, and the friction of walls and
// obstacles after each.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/pass_friction.h"
#include "kernels/pass_packed_xsph.h"
#include "kernels/pass_xsph.h"
#include "lib/program/features/correction.h"
#include "lib/program/features/motion.h"
#include "lib/scene/viscosity.h"

namespace pbf::program_module {
inline bool has_moving_friction(const Scene& s) {
  return has_obstacle_friction(s) && has_moving_obstacles(s);
}
inline bool has_friction_on_maps(const Scene& s) { return has_obstacle_friction(s) && has_maps(s); }
inline bool has_friction_loads(const Scene& s) { return has_friction(s) && has_loads(s); }
/// Friction needs the scene of solids for obstacles, and for the book of loads.
inline bool has_friction_at_solids(const Scene& s) {
  return has_obstacle_friction(s) || has_friction_loads(s);
}
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// Of each obstacle.
inline constexpr struct FrictionRows : Numbers {
} obstacle_friction{{"obstacle friction", per_obstacle, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

inline constexpr const char* kLessXsph = "lower viscosity.xsph";

/// Calls use() with the pass that reads `velocity` and writes `velocity_out`. motion: packed rows,
/// if the scene has them. bin: array for the particles' bins in the next update, or null. free:
/// field::free_velocity, with bin.
template <class G, class Lists, class Rows, class Use>
void with_xsph(const G& c, const Lists& lists, GatheredRows<Rows> position,
               GatheredRows<Rows> velocity, GatheredRows<Rows> motion, OwnRows<Rows> velocity_out,
               std::type_identity_t<Rows>* free, int* bin, const Use& use) {
  using Real = typename G::Real;
  c.with_smoothing([&](auto s) {
    const DissipationBook damping = bin ? damping_book(c) : DissipationBook{};
    with_order<decltype(s)::value, Real>(c.scene, free, damping, [&](const auto& order) {
      with_far_boundary(c, [&](const auto& boundary) {
        constexpr Smoothing S = decltype(s)::value;
        using Order = std::decay_t<decltype(order)>;
        using Boundary = std::decay_t<decltype(boundary)>;
        const XsphPass<Real, Lists, S, Order, Boundary> plain{
            c.p,      boundary,     lists, position,
            velocity, velocity_out, bin,   viscous_book<Dissipation::viscosity>(c),
            order};
        if constexpr (has_packed_rows<G> && S == Smoothing::consistent)
          if (c.plan.packed) return use(PackedXsphPass<Lists, S, Order, Boundary>{plain, motion});
        use(plain);
      });
    });
  });
}

/// The packed rows for XSPH and hyperviscosity are in an array that nothing needs until the next
/// sort writes it: the second free velocities in time steps of second order, else the second
/// positions.
template <class Free, class Position>
using PackedMotion = Needs<If<is_second_order, Free>, If<is_first_order, Position>>;
template <class G, class Free, class Position>
auto* motion_rows(const G& c, const Free& free, const Position& position) {
  return is_second_order(c.scene) ? c.declared(free) : c.declared(position);
}

/// Packs rows for XSPH.
struct PackMotion {
  static constexpr PassText text{"pack motion", "xsph", kLessXsph};
  using Needs =
      pbf::Needs<Reads<field::position, W::inverse_density>, Reads<field::velocity>,
                 PackedMotion<Writes<other<field::free_velocity>>, Writes<other<field::position>>>>;
  template <class G>
  static void launch(const G& c) {
    if constexpr (has_packed_rows<G>)
      c.items(PackMotionPass{
          c.p.dt, c[field::position], c[field::velocity],
          OwnRows(motion_rows(c, other<field::free_velocity>, other<field::position>))});
  }
};

/// The last correction of an update, which also packs rows for XSPH. In first order they would be
/// in the array that it gathers. No lambda follows, so positions are not packed.
struct DeltaPackMotion {
  using Fuses = Pair<Delta, PackMotion>;
  static constexpr PassText text{"delta+pack motion", "delta"};
  using Needs = pbf::Needs<Writes<field::position, W::inverse_density>, Reads<field::density>,
                           DeltaNeeds, ShareNeeds, Writes<other<field::free_velocity>>>;
  template <class G>
  static void launch(const G& c) {
    if constexpr (has_packed_rows<G>)
      launch_delta(c, c[field::density], nullptr, nullptr, c.declared(other<field::free_velocity>));
  }
};

template <auto& position, auto& velocity, class Motion>
using XsphNeeds = Needs<If<is_not_packed, Gathers<position, W::inverse_density>, Gathers<velocity>>,
                        If<is_packed, Reads<position, W::inverse_density>, Reads<velocity>, Motion>,
                        UsesLists, Adds<field::dissipation>>;

struct Xsph {
  static constexpr PassText text{"xsph", "xsph", kLessXsph};
  using Flips = pbf::Flips<field::velocity>;
  using Needs = pbf::Needs<XsphNeeds<field::position, other<field::velocity>,
                                     PackedMotion<Gathers<other<field::free_velocity>>,
                                                  Gathers<other<field::position>>>>,
                           Writes<field::velocity>>;
  /// Calls use(pass).
  template <class G>
  static void with(const G& c, const auto& lists, const auto& use) {
    using Rows = Vec4<typename G::Real>;
    const Rows* motion = motion_rows(c, other<field::free_velocity>, other<field::position>);
    with_xsph(c, lists, c[field::position], c[other<field::velocity>], GatheredRows<Rows>(motion),
              c[field::velocity], nullptr, nullptr, use);
  }
  static void launch(const auto& c) {
    with(c, c.lists(), [&](const auto& pass) { c.pairs(pass); });
  }
};

/// Xsph writes the velocities into the second array, and the sort gathers them back into the first.
struct XsphPredictSort {
  using Fuses = Pair<Xsph, PredictSort>;
  static constexpr PassText text{"xsph+predict+sort", "grid", kLessXsph};
  using Flips = pbf::Flips<field::position, field::free_velocity, field::id>;
  using Needs =
      pbf::Needs<XsphNeeds<other<field::position>, field::velocity,
                           PackedMotion<Gathers<field::free_velocity>, Gathers<field::position>>>,
                 SortPredictedNeeds, Places<other<field::velocity>>>;
  /// Calls use(pass, sort). sort(first): sorts after `first`, which is the pass or launches it.
  template <class G>
  static void with(const G& c, const auto& lists, const auto& use) {
    using Rows = Vec4<typename G::Real>;
    const Rows* position = c[other<field::position>];
    Rows *from = c[field::velocity], *to = c[other<field::velocity>];
    using Gathered = GatheredRows<Rows>;
    const Rows* motion = motion_rows(c, field::free_velocity, field::position);
    with_xsph(c, lists, Gathered(position), Gathered(from), Gathered(motion), OwnRows<Rows>(to),
              c.declared(other<field::free_velocity>), c[field::bin].rows(), [&](const auto& pass) {
                use(pass, [&](const auto& first) { sort_predicted(c, "xsph", first, to, from); });
              });
  }
  static void launch(const auto& c) {
    with(c, c.lists(), [](const auto& pass, const auto& sort) { sort(pass); });
  }
};

struct Viscosities;

struct Friction {
  static constexpr PassText text{"friction", "xsph", "lower friction"};
  using Needs =
      pbf::Needs<Reads<field::position>, Updates<field::velocity>, Adds<field::dissipation>,
                 If<has_friction_at_solids, Looks<field::solid_scene>>,
                 If<has_obstacle_friction, Looks<field::solids>, Looks<field::obstacle_friction>>,
                 If<has_moving_friction, Looks<field::solid_velocity>>,
                 If<has_friction_on_maps, Looks<field::solid_maps>>,
                 If<has_friction_loads, BookNeeds>>;
  template <class G>
  static void launch(const G& c) {
    c.with_smoothing([&](auto s) {
      using Real = typename G::Real;
      const auto& given = c.template memory<Viscosities>();
      FrictionPass<Real, decltype(s)::value> pass;
      pass.p = c.p;
      pass.strength = given.scale * c.p.xsph;
      std::copy(std::begin(given.of_wall), std::end(given.of_wall), std::begin(pass.of_wall));
      pass.clear = given.clear;
      pass.bounds = c.template memory<NearSolids>().solids.bounds;
      pass.obstacles = given.obstacles;
      pass.solid_scene = c.declared(field::solid_scene);
      pass.of_obstacle = c.declared(field::obstacle_friction);
      pass.solid_velocity = c.declared(field::solid_velocity);
      pass.booked = has_loads(c.scene);
      pass.position = c[field::position];
      pass.velocity = c[field::velocity];
      pass.book = viscous_book<Dissipation::friction>(c);
      c.items(pass);
    });
  }
};

struct Viscosities {
  using Passes = PassList<PackMotion, DeltaPackMotion, Xsph, XsphPredictSort, Friction>;
  static void add(const Scene& s, auto& b) {
    const int sweeps = viscous_sweeps(s).sweeps;
    if (sweeps == 0) b.left_out("xsph pass", "no key viscosity");
    for (int k = 0; k < sweeps; ++k) {
      // No feature before this one runs a pass between the iterations and the first sweep.
      const bool in_delta = k == 0 && is_second_order(s);
      if (b.shape.packed) in_delta ? b.iterated(PackMotion()) : b.after(PackMotion());
      b.after(Xsph());
      if (has_friction(s)) b.after(Friction());
    }
    if (!has_friction(s)) b.left_out("friction pass", "friction is 0 on all walls and obstacles");
  }

  template <class Real>
  struct Memory : NoMemory {
    Real scale = 0;        ///< of FrictionPass::strength
    Real of_wall[6] = {};  ///< friction
    Bounds<Real> clear{};  ///< far from walls with friction
    int obstacles = 0;     ///< 0 if none has friction

    void make(auto& c) {
      if (!has_friction(c.scene)) return;
      const Scene s = in_internal_axes(c.scene, c.plan.axes);
      scale = Real(friction_scale(s));
      Box<Real> walls = c.p.boundary;
      for (int face = 0; face < 6; ++face) {
        of_wall[face] = Real(s.domain.friction_of(face));
        if (s.dimensions == 2 && face / 2 == 1) of_wall[face] = 0;
        if (!(of_wall[face] > Real(0))) walls.walls &= ~(1u << face);
      }
      clear = clear_of(walls);
      if (!has_obstacle_friction(s)) return;
      obstacles = int(s.obstacles.size());
      std::vector<Real> each(std::size_t(solids_in(s)), Real(0));
      for (std::size_t k = 0; k < s.obstacles.size(); ++k) each[k] = Real(s.obstacles[k].friction);
      c.put(field::obstacle_friction, each);
    }
  };
};

}  // namespace pbf::PBF_VARIANT
