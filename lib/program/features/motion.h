// Prediction, sort and lists: the start of every update with pairs.
#pragma once

#include "kernels/pass_predict.h"
#include "lib/program/as_types.h"
#include "lib/program/features/solids.h"
#include "lib/program/motion.h"
#include "lib/program/pass.h"

namespace pbf::inline PBF_VARIANT {

/// Where what moves goes in the step to come; of scenes in which something does.
struct MoveSolids {
  static PassInfo info() { return {"motion", "predict", {}, {hidden({&field::motion})}}; }
  template <class C>
  static void launch(C& c) {
    c.items(1, c.moving().pass(c.placed()));
  }
};

/// x* and the velocity that goes with it, in place.
struct Predict {
  static PassInfo info() {
    return {"predict",
            "predict",
            {{&field::position}, {&field::velocity}},
            {vector({&field::position}, "position", "h"),
             vector({&field::velocity}, "velocity", "h/s")}};
  }
  template <class C>
  static void launch(C& c) {
    with_boundary(c, [&](const auto& boundary) {
      c.items(MovePass<typename C::Real, std::decay_t<decltype(boundary)>>{
          c.p, boundary, c.position(), c.velocity(), c.counts()});
    });
  }
};

inline PassInfo sort_info(const char* name) {
  std::vector<Access> reads{{&field::position}, {&field::velocity}, {&field::id}};
  std::vector<Written> writes{{{&field::bin}, Written::scalar, "bin"},
                              hidden({&field::order}),
                              hidden({&field::bin_start}),
                              vector({&field::position}, "position", "h"),
                              vector({&field::velocity}, "velocity", "h/s"),
                              hidden({&field::id})};
  writes[0].before_sort = true;
  return {name, "grid", std::move(reads), std::move(writes)};
}

/// Runs `first`, the pass that gives every particle its bin, and `listed`, which gives it to those
/// that the first leaves out; then puts the particles in the order of bins.
template <class C, class First, class Gather, class Listed>
void sort_rows(C& c, const char* stage, const First& first, const Gather& gather,
               const Listed& listed) {
  c.exec.sort_by_bin(c.booked(stage), first, listed, c.rows(), bin_count(c.p), c.ids(),
                     c.sort_order(), c.template data<int>(field::bin_start), gather);
  c.flip(field::position);
  c.flip(field::velocity);
  c.flip(field::id);
}
template <bool moving, class C, class Boundary>
auto gather_pass(C& c, const Boundary& boundary) {
  return GatherPass<typename C::Real, Boundary, moving>{c.p,
                                                        boundary,
                                                        c.position(),
                                                        c.velocity(),
                                                        c.ids(),
                                                        c.other(field::position),
                                                        c.other(field::velocity),
                                                        c.template other_data<int>(field::id),
                                                        c.counts()};
}
/// With particles as predicted from c.position() and c.velocity().
template <class C, class First>
void sort_predicted(C& c, const char* stage, const First& first) {
  using Real = typename C::Real;
  const auto gather = gather_pass<true>(c, first.boundary);
  if constexpr (First::leaves_rows)
    with_dimensions(c.p.dimensions, [&](auto d) {
      const Solids<Real> solids = solids_of(c);
      sort_rows(c, stage, first, gather,
                Listed<NearPredictPass<Real, decltype(d)::value>>{
                    solids.near.way_left_squared ? solids.near.count : nullptr,
                    {c.p, solids, c.position(), c.velocity(), c.template data<int>(field::bin),
                     c.counts()}});
    });
  else
    sort_rows(c, stage, first, gather, NothingListed{});
}

/// The positions as they are.
struct Sort {
  static PassInfo info() { return sort_info("sort"); }
  template <class C>
  static void launch(C& c) {
    with_dimensions(c.p.dimensions, [&](auto d) {
      sort_rows(c, "predict",
                BinPass<typename C::Real, decltype(d)::value>{c.p, c.position(),
                                                              c.template data<int>(field::bin)},
                gather_pass<false>(c, c.p.boundary), NothingListed{});
    });
  }
};

/// x* is computed for its bin, and once more where the particles are gathered, which is cheaper
/// than writing and reading it.
struct PredictSort {
  using Fuses = Pair<Predict, Sort>;
  static PassInfo info() { return sort_info("predict+sort"); }
  template <class C>
  static void launch(C& c) {
    with_dimensions(c.p.dimensions, [&](auto d) {
      with_far_boundary(c, [&](const auto& boundary) {
        sort_predicted(
            c, "predict",
            PredictPass<typename C::Real, std::decay_t<decltype(boundary)>, decltype(d)::value>{
                c.p, boundary, c.position(), c.velocity(), c.template data<int>(field::bin)});
      });
    });
  }
};

struct MakeLists {
  static PassInfo info() {
    return {"lists",
            "neighbors",
            {{&field::position}, {&field::bin_start}},
            {{{&field::lists}, Written::pairs}}};
  }
  template <class C>
  static void launch(C& c) {
    c.make_lists();
  }
};

/// Where they stand in an update is the program's own matter (program.cpp).
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
