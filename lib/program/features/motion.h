// Prediction, sort and lists: the start of every update with pairs.
#pragma once

#include "kernels/pass_predict.h"
#include "lib/program/as_types.h"
#include "lib/program/features/solids.h"
#include "lib/program/motion.h"
#include "lib/program/pass.h"

namespace pbf::inline PBF_VARIANT {

/// Puts moving obstacles and the tank at their places for the step. Only in scenes with motion.
struct MoveSolids {
  static constexpr PassText text{"motion", "predict"};
  using Needs = pbf::Needs<Writes<field::motion>>;
  template <class G>
  static void launch(const G& c) {
    auto& parts = c.context();
    c.items(1, parts.moving().pass(parts.placed()));
  }
};

/// Computes x* and the predicted velocity, in place.
struct Predict {
  static constexpr PassText text{"predict", "predict"};
  using Needs = pbf::Needs<Updates<field::position, W::mark>, Updates<field::velocity>, MoveNeeds>;
  template <class G>
  static void launch(const G& c) {
    auto& parts = c.context();
    with_boundary(parts, [&](const auto& boundary) {
      c.items(MovePass<typename G::Real, std::decay_t<decltype(boundary)>>{
          c.p, boundary, c[field::position], c[field::velocity], parts.counts()});
    });
  }
};

/// The needs of a sort apart from positions. The second arrays hold the rows before the sort. The
/// executor decides which array holds the order.
using GatherNeeds = Needs<Writes<field::bin>, Places<field::order>, Places<field::bin_start>,
                          Looks<other<field::id>>, Places<field::id>, Places<field::velocity>>;

/// Runs `first`, which computes the bin of each particle, and `listed`, which does it for particles
/// that `first` leaves out. Then `gather` puts the particles into the order of bins.
template <class G, class First, class Gather, class Listed>
void sort_rows(const G& c, const char* stage, const First& first, const Gather& gather,
               const Listed& listed) {
  auto& parts = c.context();
  parts.exec.sort_by_bin(parts.booked(stage), first, listed, c.rows(), bin_count(c.p),
                         c[other<field::id>], parts.sort_order(), c[field::bin_start], gather);
}
/// velocity, velocity_out: the arrays from which and into which the pass gathers.
template <bool moving, class G, class Boundary, class Vectors>
auto gather_pass(const G& c, const Boundary& boundary, const Vectors* velocity,
                 Vectors* velocity_out) {
  return GatherPass<typename G::Real, Boundary, moving>{c.p,
                                                        boundary,
                                                        c[other<field::position>],
                                                        velocity,
                                                        c[other<field::id>],
                                                        c[field::position],
                                                        velocity_out,
                                                        c[field::id],
                                                        c.context().counts()};
}
/// Predicts the particles and sorts them by the bins of x*.
template <class G, class First, class Vectors>
void sort_predicted(const G& c, const char* stage, const First& first, Vectors* velocity,
                    Vectors* velocity_out) {
  using Real = typename G::Real;
  using Rows = OwnRows<Vec4<Real>>;
  const auto gather = gather_pass<true>(c, first.boundary, velocity, velocity_out);
  if constexpr (First::leaves_rows)
    with_dimensions(c.p.dimensions, [&](auto d) {
      auto& parts = c.context();
      const Solids<Real> solids = solids_of(parts);
      sort_rows(c, stage, first, gather,
                Listed<NearPredictPass<Real, decltype(d)::value>>{
                    solids.near.way_left_squared ? solids.near.count : nullptr,
                    {c.p, solids, Rows(c[other<field::position>]), Rows(velocity),
                     c[field::bin].rows(), parts.counts()}});
    });
  else
    sort_rows(c, stage, first, gather, NothingListed{});
}

/// Sorts by the bins of the present positions.
struct Sort {
  static constexpr PassText text{"sort", "grid"};
  using Flips = pbf::Flips<field::position, field::velocity, field::id>;
  using Needs = pbf::Needs<Looks<other<field::position>>, Looks<other<field::velocity>>,
                           Writes<field::bin>, Places<field::position>, GatherNeeds>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    with_dimensions(c.p.dimensions, [&](auto d) {
      sort_rows(
          c, "predict",
          BinPass<Real, decltype(d)::value>{
              c.p, OwnRows<const Vec4<Real>>(c[other<field::position>]), c[field::bin].rows()},
          gather_pass<false>(c, c.p.boundary, c[other<field::velocity>], c[field::velocity]),
          NothingListed{});
    });
  }
};

/// Rows near solids are predicted in place, before the others.
using SortPredictedNeeds =
    Needs<Looks<other<field::position>>,
          If<has_solids, Looks<field::near_row>, Places<other<field::position>>>,
          Writes<field::bin>, Places<field::position, W::mark>, GatherNeeds, MoveNeeds>;

/// Computes x* twice, for the bin and when the particles are gathered. This is cheaper than storing
/// x* and reading it again.
struct PredictSort {
  using Fuses = Pair<Predict, Sort>;
  static constexpr PassText text{"predict+sort", "grid"};
  using Flips = Sort::Flips;
  using Needs = pbf::Needs<SortPredictedNeeds, Looks<other<field::velocity>>,
                           If<has_solids, Places<other<field::velocity>>>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    using Rows = OwnRows<const Vec4<Real>>;
    with_dimensions(c.p.dimensions, [&](auto d) {
      with_far_boundary(c.context(), [&](const auto& boundary) {
        Vec4<Real>* velocity = c[other<field::velocity>];
        sort_predicted(c, "predict",
                       PredictPass<Real, std::decay_t<decltype(boundary)>, decltype(d)::value>{
                           c.p, boundary, Rows(c[other<field::position>]), Rows(velocity),
                           c[field::bin].rows()},
                       velocity, c[field::velocity]);
      });
    });
  }
};

struct MakeLists {
  static constexpr PassText text{"lists", "neighbors"};
  using Needs = pbf::Needs<Gathers<field::position>, Looks<field::bin_start>, MakesLists>;
  template <class G>
  static void launch(const G& c) {
    c.context().make_lists();
  }
};

/// make_program() (program.cpp) itself adds Predict, Sort and MakeLists to an update.
struct Motion {
  using Passes = PassList<MoveSolids, Predict, Sort, PredictSort, MakeLists>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (has_motion(s)) b.template start<MoveSolids>();
    if (!s.obstacles.empty() && !has_moving_obstacles(s))
      b.left_out("motion of obstacles", "no obstacle has motion");
    if (!s.tank_motion) b.left_out("motion of the tank", "no key tank_motion");
  }
};

}  // namespace pbf::inline PBF_VARIANT
