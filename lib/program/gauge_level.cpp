#include <algorithm>

#include "kernels/boundary/box.h"
#include "kernels/boundary/solid_term.h"
#include "lib/program/gauges.h"
#include "lib/scene/surface.h"

namespace pbf::inline program_module {
namespace {

using gauge_kinds::Level;

constexpr int kPerH = 8;  ///< sample points of a level gauge per h

/// The walls with scale and range 1, so that term() gives the share of the kernel behind them.
Box<double> whole_kernel_walls(const Scene& s, const Axes& axes) {
  Box<double> box;
  double extent[3];
  box.walls = 0;
  for (int k = 0; k < 3; ++k) {
    const int a = axes.of[k];
    extent[k] = (s.domain.max[std::size_t(a)] - s.domain.min[std::size_t(a)]) / s.h();
    if (s.dimensions == 2 && a == 1) continue;
    for (const int high : {0, 1})
      if (!s.domain.is_open(a, high == 1)) box.walls |= 1u << (2 * k + high);
  }
  box.extent = {extent[0], extent[1], extent[2]};
  return box;
}

template <int D>
void take_line(Level& level, const Box<double>& walls, const std::vector<Solid<double>>& solids) {
  const Probe& p = level.site;
  constexpr Smoothing poly6 = D == 2 ? Smoothing::paper_2d : Smoothing::paper;
  const auto at = [&](double n) {
    double x[3] = {p.from[0], p.from[1], p.from[2]};
    x[p.axis] += n * p.step;
    return Vec3<double>{x[0], x[1], x[2]};
  };
  const auto free = [&](double n) {
    return std::none_of(solids.begin(), solids.end(),
                        [&](const Solid<double>& o) { return distance<D>(o, at(n)) < 0; });
  };
  for (int n = 0; n < p.count; ++n) {
    double share = 0;
    for (const Solid<double>& o : solids) share += solid_term<poly6>(o, at(n), 1.0).share;
    level.room.push_back((1 - walls.term<poly6>(at(n)).density) * std::max(1 - share, 0.0));
  }
  for (int n = 0; n + 1 < p.count; ++n) {
    const bool here = free(n), there = free(n + 1);
    Level::Piece piece;
    if (!here && !there) piece.to = 0;
    if (here != there) {
      double a = 0, b = 1;  // the surface lies between
      for (int k = 0; k < 40; ++k) (free(n + (a + b) / 2) == here ? a : b) = (a + b) / 2;
      (here ? piece.to : piece.from) = a;
    }
    level.pieces.push_back(piece);
  }
}

/// The fraction of a piece that is wet and outside of obstacles. `a`, `b`: at its two ends, fluid
/// fraction minus half of the free space; linear between them, wet where positive. So the surface
/// is where fluid fills half of the free space, also beside walls.
double wet_part(double a, double b, const Level::Piece& free) {
  double from = 0, to = 1;
  if (!(a > 0) && !(b > 0)) return 0;
  if (!(a > 0)) from = a / (a - b);
  if (!(b > 0)) to = a / (a - b);
  return std::max(std::min(to, free.to) - std::max(from, free.from), 0.0);
}

}  // namespace

namespace gauge_kinds {

Level::Level(const Keys& keys, const GaugeFrame& frame) : h(frame.scene.h()) {
  const Scene& s = frame.scene;
  const bool flat = s.dimensions == 2;
  const double third = flat ? s.domain.max[1] - s.domain.min[1] : h;
  weight = frame.mass / (s.fluid.rest_density * h * h * third) *
           (flat ? Poly6<double, 2>::norm : Poly6<double>::norm) / double(kProbeUnits);
  grains[0].value = h * weight * frame.particles_around();
  Double3 from = s.domain.min;
  const std::vector<int> across = axes_across_level(s);
  for (std::size_t k = 0; k < across.size(); ++k) from[std::size_t(across[k])] = keys.at[k];
  frame.place(from, site.from);
  site.axis = frame.axes.inside(level_axis(s));
  const auto a = std::size_t(level_axis(s));
  const double length = (s.domain.max[a] - s.domain.min[a]) / h;
  const int number = int(std::min(std::ceil(length * kPerH), 1e6));
  site.step = length / number;
  site.count = number + 1;
  site.first = frame.first;
  const Box<double> walls = whole_kernel_walls(s, frame.axes);
  flat ? take_line<2>(*this, walls, frame.solids) : take_line<3>(*this, walls, frame.solids);
}

std::string Level::place(const Keys& keys, const Scene& s) {
  std::string out;
  const std::vector<int> across = axes_across_level(s);
  for (std::size_t k = 0; k < across.size(); ++k)
    out += format("%s%c = %.6g m", out.empty() ? "" : ", ", 'x' + across[k], keys.at[k]);
  return out;
}

void Level::finish(const ProbeSums* sums, double* out) const {
  const auto above = [&](std::size_t n) { return weight * double(sums[n].weight) - 0.5 * room[n]; };
  double wet = 0, here = above(0);
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const double next = above(n + 1);
    wet += wet_part(here, next, pieces[n]);
    here = next;
  }
  *out = h * (wet * site.step);
}

}  // namespace gauge_kinds
}  // namespace pbf::inline program_module
