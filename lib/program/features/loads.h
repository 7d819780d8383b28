// Loads: the forces of the fluid on walls and obstacles. Passes that move particles book them
// (kernels/boundary/loads.h); a pass at the end of an update adds them up.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/boundary/solid_boundary.h"
#include "kernels/params.h"
#include "lib/program/features/poses.h"
#include "lib/program/loads.h"
#include "lib/program/time_order.h"

namespace pbf::program_module {
inline std::int64_t per_wall(const Sizes& n) { return load_walls(n.scene); }
template <class Tally>
std::int64_t per_gauge(const Sizes& n) {
  return gauges_of<Tally>(n.scene);
}
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// Per wall: kLoadParts times LoadSums; 0 between two updates.
inline constexpr struct LoadRows : Plain<LoadSums, kLoadParts, std::int64_t> {
} load_sums{{"load sums", per_wall, Life::update}};
/// The same of predictions, in time steps of second order: no share of it is taken over.
inline constexpr struct ClampRows : Plain<LoadSums, kLoadParts, std::int64_t> {
} clamp_sums{{"clamp sums", per_wall, Life::update}};
/// Since the last reading; the rows are those of program/loads.h.
inline constexpr struct WallLoads : Plain<Load> {
} loads{{"loads", per_wall, Life::state}};
inline constexpr struct WallPushes : Plain<WallPush> {
} wall_pushes{{"wall pushes", per_wall, Life::state}};
/// What the kernels know of the gauges of a tally.
template <class Tally>
struct GaugeSites : Plain<typename Tally::Site> {};
template <class Tally>
inline constexpr GaugeSites<Tally> gauge_sites{{Tally::sites, per_gauge<Tally>, Life::run}};
inline constexpr auto& patches = gauge_sites<PatchTally>;
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

/// h, a power of two above the longest edge: the unit of moments.
template <class Real>
double moment_unit(const Box<Real>& box) {
  const double longest =
      std::max({double(box.extent.x), double(box.extent.y), double(box.extent.z)});
  return std::exp2(std::ceil(std::log2(longest)));
}

/// Whether the next steps take over a share of what walls give to particles.
inline bool carries_loads(const Scene& s) { return has_loads(s) && is_second_order(s); }
inline bool carries_no_loads(const Scene& s) { return has_loads(s) && !is_second_order(s); }

/// The needs of a pass that books loads; of one that books those of predictions.
using BookNeeds =
    Needs<If<has_loads, Adds<field::load_sums>>, If<has_pressure_gauges, Looks<field::patches>>>;
using StartBookNeeds =
    Needs<If<carries_loads, Adds<field::clamp_sums>>, If<carries_no_loads, Adds<field::load_sums>>,
          If<has_pressure_gauges, Looks<field::patches>>>;

/// sums: the rows of field::load_sums, or null;
/// clamps: those of field::clamp_sums, or null; patch: those of field::patches.
template <class Real>
LoadBook<Real> load_book(const Scene& scene, const Box<Real>& box, LoadSums* sums, LoadSums* clamps,
                         const Patch* patch) {
  return {sums,
          clamps,
          Real(1 / moment_unit(box)),
          patch,
          gauges_of<PatchTally>(scene),
          summed_walls(scene)};
}

struct CarryLoads {
  static constexpr PassText text{"carried loads", "predict"};
  using Needs = pbf::Needs<Updates<field::load_sums>, Updates<field::wall_pushes>>;
  template <class G>
  static void launch(const G& c) {
    c.items(int(load_walls(c.scene)),
            CarryLoadsPass{c[field::load_sums].rows(), c[field::wall_pushes].rows(), kCarriedPush});
  }
};

struct SumLoads {
  static constexpr PassText text{"loads", "measure"};
  using Needs =
      pbf::Needs<Updates<field::load_sums>, Updates<field::loads>,
                 If<carries_loads, Updates<field::wall_pushes>, Updates<field::clamp_sums>>,
                 If<has_moving_obstacles, Looks<field::solid_velocity>>>;
  static void launch(const auto& c) {
    c.items(int(load_walls(c.scene)),
            LoadPass{c[field::load_sums].rows(), c[field::loads].rows(), double(c.p.inv_dt),
                     double(c.p.update_dt), moment_unit(c.p.boundary), c[field::solid_velocity],
                     int(c.scene.obstacles.size()), c[field::wall_pushes].rows(),
                     c[field::clamp_sums].rows()});
  }
};

struct Loads {
  using Passes = PassList<CarryLoads, SumLoads>;
  static void add(const Scene& s, auto& b) {
    if (!has_loads(s))
      return b.left_out("loads on the walls",
                        "domain.loads is false, and no obstacle has loads or motion");
    if (carries_loads(s)) b.start(CarryLoads());
    b.end(SumLoads());
  }
};

}  // namespace pbf::PBF_VARIANT
