// The casings of emitters as solids.
#include "lib/program/emission.h"
#include "lib/program/obstacles.h"

namespace pbf::program_module {
namespace {

/// Between the bore and the cells of its columns, so that layers fit.
constexpr double kGap = 0.1;  // spacings

/// A body from the opening to `depth` behind it, wider than the opening by `wider`; m.
Solid<double> body_of(const NozzlePlace& n, double depth, double wider, const Scene& s) {
  const double h = s.h(), half = 0.5 * depth / h;
  const Double3 o = s.origin(), at = n.center - (0.5 * depth) * n.normal;
  const bool flat = s.dimensions == 2;
  Solid<double> out;
  if (n.disc)
    out.shape = shape::Cylinder<double>{(n.half[0] + wider) / h, half};
  else
    out.shape = shape::Box<double>{{(n.half[0] + wider) / h, (n.half[1] + wider) / h, half}};
  out.center = {(at[0] - o[0]) / h, flat ? 0 : (at[1] - o[1]) / h, (at[2] - o[2]) / h};
  const Double3 rows[3] = {n.side[0], flat ? Double3{0, 1, 0} : n.side[1], n.normal};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) out.turn[r][k] = rows[r][k];
  return out;
}

}  // namespace

std::vector<Solid<double>> casings_of(const Scene& s) {
  std::vector<Solid<double>> all;
  for (const Emitter& e : s.emitters) {
    const NozzlePlace n = nozzle_place(s, e);
    all.push_back(body_of(n, n.length(), n.wall, s));
  }
  return all;
}

std::vector<Solid<double>> casings_and_bores(const Scene& s, const Axes& axes) {
  std::vector<Solid<double>> all = casings_of(s);
  for (const Emitter& e : s.emitters) {
    const NozzlePlace n = nozzle_place(s, e);
    all.push_back(body_of(n, n.depth, kGap * s.fluid.spacing, s));
  }
  turn_to_internal(axes, all);
  return all;
}

}  // namespace pbf::program_module
