// Prediction, sort and lists: the start of every update with pairs.
#pragma once

#include "kernels/pass_move_solids.h"
#include "kernels/pass_predict.h"
#include "kernels/row_state.h"
#include "lib/program/as_types.h"
#include "lib/program/features/body_rows.h"
#include "lib/program/features/solids.h"
#include "lib/program/motion.h"
#include "lib/program/packed_rows.h"
#include "lib/program/pass.h"
#include "lib/program/time_order.h"

namespace pbf::program_module {
inline std::int64_t per_table_row(const Sizes& n) { return motion_table_rows(n.plan); }
inline std::int64_t per_pose_step(const Sizes& n) {
  return motion_table_rows(n.plan) * prescribed_obstacles(n.scene);
}
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// Prescribed motion: the present row of the tables, and the tables of the steps to come.
inline constexpr struct StepRow : Plain<int> {
} step_row{{"step row", one_row, Life::run}};
inline constexpr struct FrameSteps : Objects {
} frame_steps{{kBytesOf<FrameStep>, "frame steps", per_table_row, Life::run}};
inline constexpr struct PoseSteps : Objects {
} pose_steps{{kBytesOf<PoseStep>, "pose steps", per_pose_step, Life::run}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

template <class Real>
FrameStep<Real> row_of(const field::FrameSteps&);
template <class Real>
PoseStep<Real> row_of(const field::PoseSteps&);

/// Puts moving obstacles and the tank at their places for the step. Only in scenes with motion.
struct MoveSolids {
  static constexpr PassText text{"motion", "predict"};
  using Needs =
      pbf::Needs<Looks<field::step_row>, Places<field::step_row>,
                 If<has_tank_motion, Looks<field::frame_steps>, Places<field::frame>>,
                 If<has_prescribed_obstacles, Looks<field::pose_steps>, Places<field::solids>,
                    Places<field::solids_before>, Places<field::solid_velocity>>>;
  template <class G>
  static void launch(const G& c) {
    c.items(1, MoveSolidsPass<typename G::Real>{
                   c[field::step_row], c[field::frame_steps], c[field::pose_steps],
                   int(prescribed_obstacles(c.scene)), c[field::frame], c[field::solids],
                   c[field::solids_before], c[field::solid_velocity]});
  }
};

/// Computes x* and the predicted velocity, in place.
struct Predict {
  static constexpr PassText text{"predict", "predict"};
  using Needs =
      pbf::Needs<Updates<field::position, W::mark>, PacksPositions, Updates<field::velocity>,
                 If<is_second_order, Updates<field::free_velocity>>, StepNeeds, FrameNeeds>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    with_order<Real>(
        c.scene, c.declared(field::free_velocity), damping_book(c), [&](const auto& order) {
          with_boundary(c, [&](const auto& boundary) {
            c.items(MovePass<Real, std::decay_t<decltype(boundary)>, std::decay_t<decltype(order)>>{
                c.p, boundary, moved_rows(c), c[field::velocity], c[field::counts].sums(), order});
          });
        });
  }
};

/// The needs of a sort apart from positions. The second arrays hold the rows before the sort. The
/// executor decides which array holds the order.
using GatherNeeds =
    Needs<Writes<field::bin>, Places<field::order>, Places<field::bin_start>,
          Looks<other<field::id>>, Places<field::id>, Places<field::velocity>,
          If<is_second_order, Looks<other<field::free_velocity>>, Places<field::free_velocity>>,
          If<changes_rows, Looks<field::row_state>, Places<field::row_state>>>;

/// Runs `first`, which computes the bin of each particle, and `listed`, which does it for particles
/// that `first` leaves out. Then `gather` puts the particles into the order of bins. If `first` is
/// launched with other passes (lib/solver/turns.h), particles neither come nor go.
template <class G, class First, class Gather, class Listed>
void sort_rows(const G& c, const char* stage, const First& first, const Gather& gather,
               const Listed& listed) {
  const auto sort = [&]<bool leave>(std::bool_constant<leave>, const auto& n) {
    return c.exec.template sort_by_bin<leave>(c.booked(stage), first, listed, n, bin_count(c.p),
                                              c[other<field::id>], c.sort_order(),
                                              c[field::bin_start], gather);
  };
  if constexpr (requires { first.launch; }) {
    sort(std::false_type(), c.capacity());
  } else {
    const int* rows = sort(std::bool_constant<G::changes_rows>(), c.rows());
    if constexpr (G::changes_rows)
      if (changes_rows(c.scene)) c.items(1, TakeRowsPass{rows, c[field::row_state]});
  }
}
/// velocity, velocity_out: the arrays from which and into which the pass gathers. counts: null if
/// particles do not move. order: of the rows before the sort.
template <bool moving, class G, class Boundary, class Vectors, class Order>
auto gather_pass(const G& c, const Boundary& boundary, const Vectors* velocity,
                 Vectors* velocity_out, StepCounts* counts, const Order& order) {
  const auto carried = c.carried();
  Order sorted = order;
  if constexpr (Order::second) sorted.free = c[field::free_velocity];
  return GatherPass<typename G::Real, Boundary, moving, std::decay_t<decltype(carried)>, Order>{
      carried,       c.p,
      boundary,      c[other<field::position>],
      velocity,      c[other<field::id>],
      moved_rows(c), velocity_out,
      c[field::id],  counts,
      order,         sorted};
}
/// Predicts the particles and sorts them by the bins of x*.
template <class G, class First, class Vectors>
void sort_predicted(const G& c, const char* stage, const First& first, Vectors* velocity,
                    Vectors* velocity_out) {
  using Real = typename G::Real;
  using Rows = OwnRows<Vec4<Real>>;
  StepCounts* counts = c[field::counts].sums();
  const auto gather =
      gather_pass<true>(c, first.boundary, velocity, velocity_out, counts, first.order);
  if constexpr (First::leaves_rows)
    with_dimensions(c.p.dimensions, [&](auto d) {
      const SolidBoundary<Real> solids = solids_of(c);
      sort_rows(
          c, stage, first, gather,
          Listed<NearPredictPass<Real, decltype(d)::value, std::decay_t<decltype(first.order)>>>{
              solids.near.way_left_squared ? solids.near.count : nullptr,
              {c.p, solids, Rows(c[other<field::position>]), Rows(velocity), c[field::bin].rows(),
               counts, first.order}});
    });
  else
    sort_rows(c, stage, first, gather, NothingListed{});
}

/// Sorts by the bins of the present positions.
struct Sort {
  static constexpr PassText text{"sort", "grid"};
  using Flips = pbf::Flips<field::position, field::velocity, field::free_velocity, field::id>;
  using Needs = pbf::Needs<Looks<other<field::position>>, Looks<other<field::velocity>>,
                           Writes<field::bin>, Places<field::position>, PlacesPacked, GatherNeeds>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    with_order<Real>(c.scene, c.declared(other<field::free_velocity>), {}, [&](const auto& order) {
      with_dimensions(c.p.dimensions, [&](auto d) {
        sort_rows(
            c, "predict",
            BinPass<Real, decltype(d)::value>{
                c.p, OwnRows<const Vec4<Real>>(c[other<field::position>]), c[field::bin].rows()},
            gather_pass<false>(c, c.p.boundary, c[other<field::velocity>], c[field::velocity],
                               nullptr, order),
            NothingListed{});
      });
    });
  }
};

/// Rows near solids are predicted in place, before the others.
using SortPredictedNeeds = Needs<
    Looks<other<field::position>>,
    If<has_solids, Looks<field::near_row>, Looks<field::near_count>, Places<other<field::position>>,
       If<is_second_order, Places<other<field::free_velocity>>>>,
    Writes<field::bin>, Places<field::position, W::mark>, PlacesPacked, GatherNeeds, StepNeeds,
    FrameNeeds>;

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
    with_order<Real>(
        c.scene, c.declared(other<field::free_velocity>), damping_book(c), [&](const auto& order) {
          with_dimensions(c.p.dimensions, [&](auto d) {
            with_far_boundary(c, [&](const auto& boundary) {
              Vec4<Real>* velocity = c[other<field::velocity>];
              sort_predicted(c, "predict",
                             PredictPass<Real, std::decay_t<decltype(boundary)>, decltype(d)::value,
                                         std::decay_t<decltype(order)>>{
                                 c.p, boundary, Rows(c[other<field::position>]), Rows(velocity),
                                 c[field::bin].rows(), order},
                             velocity, c[field::velocity]);
            });
          });
        });
  }
};

struct MakeLists {
  static constexpr PassText text{"lists", "neighbors"};
  using Needs = pbf::Needs<Gathers<field::position>, Looks<field::bin_start>, MakesLists>;
  static void launch(const auto& c) { c.make_lists(); }
};

/// make_program() (program.cpp) itself adds Predict, Sort and MakeLists to an update.
struct Motion {
  using Passes = PassList<MoveSolids, Predict, Sort, PredictSort, MakeLists>;
  static void add(const Scene& s, auto& b) {
    if (has_prescribed_motion(s)) b.start(MoveSolids());
    if (!s.obstacles.empty() && !has_moving_obstacles(s))
      b.left_out("motion of obstacles", "no obstacle has motion");
    if (!s.tank_motion) b.left_out("motion of the tank", "no key tank_motion");
  }

  template <class Real>
  struct Memory : NoMemory {
    static std::int64_t most_steps(const Scene& s, const Plan& plan) {
      return has_prescribed_motion(s) ? std::max(1, kMotionRows / plan.substeps)
                                      : NoMemory::most_steps(s, plan);
    }
    /// Puts the obstacles at their places at `time`, until a step moves them.
    void stand(auto& c, double time) {
      if (!has_obstacles(c.scene)) return;
      const std::vector<BodyMotion> bodies = read_bodies(c);
      std::vector<PosedSolid<Real>> all =
          placed_at(with_bodies(c.scene, bodies), c.plan, c.p.boundary, time);
      const MapAddresses<Real>& maps = c.template memory<NearSolids>().maps;
      for (std::size_t k = 0; k < all.size(); ++k) maps.set(k, all[k].solid);
      c.put(field::solids, all);
      if (!has_moving_obstacles(c.scene)) return;
      std::vector<Solid<Real>> solids;
      for (const PosedSolid<Real>& s : all) solids.push_back(s.solid);
      c.put(field::solids_before, solids);
      c.put(field::solid_velocity, std::vector<SolidVelocity>(all.size()));
    }
    /// The table of the steps to come.
    void before_steps(auto& c, const StepRange& steps) {
      if (!has_prescribed_motion(c.scene) || !(c.p.dt > 0)) return;
      MotionRows<Real> rows =
          motion_rows<Real>(c.scene, c.plan, c.p.boundary, steps, c.plan.substeps);
      const MapAddresses<Real>& maps = c.template memory<NearSolids>().maps;
      for (PoseStep<Real>& step : rows.steps) {
        maps.set(std::size_t(step.solid), step.now.solid);
        maps.set(std::size_t(step.solid), step.before);
      }
      c.put(field::step_row, std::vector<int>{0});
      if (has_tank_motion(c.scene)) c.put(field::frame_steps, rows.frames);
      if (has_prescribed_obstacles(c.scene)) c.put(field::pose_steps, rows.steps);
    }
  };
};

}  // namespace pbf::PBF_VARIANT
