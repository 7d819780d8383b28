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
/// Of each wall kLoadParts times LoadSums; 0 between two updates.
inline constexpr FieldInfo load_sums{"load sums", Type::int64, 6 * kLoadParts, Rows::walls};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

/// h, a power of two above the longest edge: the unit of moments.
template <class Real>
double moment_unit(const Box<Real>& box) {
  const double longest =
      std::max({double(box.extent.x), double(box.extent.y), double(box.extent.z)});
  return std::exp2(std::ceil(std::log2(longest)));
}

template <class C>
LoadSums* load_sums(C& c) {
  return c.template data<LoadSums>(field::load_sums);
}
template <class C>
LoadBook<typename C::Real> load_book(C& c) {
  return {load_sums(c), typename C::Real(1 / moment_unit(c.p.boundary)), c.gauges.patch.data(),
          int(c.gauges.patch.size()), summed_walls(c.scene)};
}

struct SumLoads {
  static PassInfo info() {
    return {"loads", "measure", {{&field::load_sums}}, {hidden({&field::load_sums})}};
  }
  template <class C>
  static void launch(C& c) {
    c.items(
        int(load_walls(c.scene)),
        LoadPass{load_sums(c), c.loads(), double(c.p.inv_dt), double(c.p.update_dt),
                 moment_unit(c.p.boundary), c.moving().velocity(), int(c.scene.obstacles.size())});
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
