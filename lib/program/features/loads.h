// Loads: the forces of the fluid on walls and obstacles. Passes that move particles book them
// (kernels/boundary/loads.h); a pass at the end of an update adds them up.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/boundary/solids.h"
#include "kernels/params.h"
#include "lib/program/loads.h"
#include "lib/program/pass.h"

namespace pbf::inline program_module::field {
/// Per wall: kLoadParts times LoadSums; 0 between two updates.
inline constexpr struct LoadRows : Plain<LoadSums, kLoadParts, std::int64_t> {
} load_sums{{"load sums", per_wall, Life::update}};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// h, a power of two above the longest edge: the unit of moments.
template <class Real>
double moment_unit(const Box<Real>& box) {
  const double longest =
      std::max({double(box.extent.x), double(box.extent.y), double(box.extent.z)});
  return std::exp2(std::ceil(std::log2(longest)));
}

/// The needs of a pass that books loads.
using BookNeeds = If<has_loads, Adds<field::load_sums>>;

/// sums: the rows of field::load_sums, or null.
template <class C>
LoadBook<typename C::Real> load_book(C& c, LoadSums* sums) {
  return {sums, typename C::Real(1 / moment_unit(c.p.boundary)), c.gauges.patch.data(),
          int(c.gauges.patch.size()), summed_walls(c.scene)};
}

struct SumLoads {
  static constexpr PassText text{"loads", "measure"};
  using Needs = pbf::Needs<Updates<field::load_sums>>;
  template <class G>
  static void launch(const G& c) {
    auto& parts = c.context();
    c.items(int(load_walls(c.scene)),
            LoadPass{c[field::load_sums].rows(), parts.loads(), double(c.p.inv_dt),
                     double(c.p.update_dt), moment_unit(c.p.boundary), parts.moving().velocity(),
                     int(c.scene.obstacles.size())});
  }
};

struct Loads {
  using Passes = PassList<SumLoads>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (!has_loads(s))
      return b.left_out("loads on the walls",
                        "domain.loads is false, and no obstacle has loads or motion");
    b.template end<SumLoads>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
