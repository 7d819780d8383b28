// Where fluid can be along the line of a gauge, and how much of it is wet.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/axes.h"
#include "kernels/boundary/box.h"
#include "kernels/boundary/solid_term.h"
#include "kernels/gauge_probe.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// The interval between two sample points of a line.
struct LevelPiece {
  double from = 0, to = 1;  ///< the part of it outside of obstacles, as fractions
};

/// Where fluid can be along a line.
struct LevelLine {
  std::vector<double> free_share;  ///< at each point, the share of the kernel outside of solids
  std::vector<LevelPiece> pieces;  ///< between the points
};

/// The walls with scale and range 1, so that term() gives the share of the kernel behind them.
inline Box<double> whole_kernel_walls(const Scene& s, const Axes& axes) {
  Box<double> box;
  double extent[3];
  box.walls = 0;
  for (int k = 0; k < 3; ++k) {
    const int a = axes.of[k];
    extent[k] = (s.domain.max[std::size_t(a)] - s.domain.min[std::size_t(a)]) / s.h();
    if (s.dimensions == 2 && a == 1) continue;
    for (const int high : {0, 1})
      if (s.domain.has_wall(a, high == 1)) box.walls |= 1u << (2 * k + high);
  }
  box.extent = {extent[0], extent[1], extent[2]};
  return box;
}

template <int D>
LevelLine level_line(const Probe& p, const Box<double>& walls,
                     const std::vector<Solid<double>>& solids) {
  constexpr Smoothing poly6 = D == 2 ? Smoothing::paper_2d : Smoothing::paper;
  const auto at = [&](double n) {
    double x[3] = {p.from[0], p.from[1], p.from[2]};
    if (p.axis == Probe::inclined)
      for (int k = 0; k < 3; ++k) x[k] += n * p.step * p.direction[k];
    else
      x[p.axis] += n * p.step;
    return Vec3<double>{x[0], x[1], x[2]};
  };
  const auto free = [&](double n) {
    return std::none_of(solids.begin(), solids.end(),
                        [&](const Solid<double>& o) { return distance<D>(o, at(n)) < 0; });
  };
  LevelLine line;
  for (int n = 0; n < p.count; ++n) {
    double share = 0;
    for (const Solid<double>& o : solids) share += solid_term<poly6>(o, at(n), 1.0).share;
    line.free_share.push_back((1 - walls.term<poly6>(at(n)).density) * std::max(1 - share, 0.0));
  }
  for (int n = 0; n + 1 < p.count; ++n) {
    const bool here = free(n), there = free(n + 1);
    LevelPiece piece;
    if (!here && !there) piece.to = 0;
    if (here != there) {
      double a = 0, b = 1;  // the surface lies between
      for (int k = 0; k < 40; ++k) (free(n + (a + b) / 2) == here ? a : b) = (a + b) / 2;
      (here ? piece.to : piece.from) = a;
    }
    line.pieces.push_back(piece);
  }
  return line;
}

/// The part of a piece that is wet and outside of obstacles, empty if to <= from. `a`, `b`: at its
/// two ends, fluid fraction minus half of the free space; linear between them, wet where positive.
/// So the surface is where fluid fills half of the free space, also beside walls.
inline LevelPiece wet_part(double a, double b, const LevelPiece& free) {
  double from = 0, to = 1;
  if (!(a > 0) && !(b > 0)) return {0, 0};
  if (!(a > 0)) from = a / (a - b);
  if (!(b > 0)) to = a / (a - b);
  return {std::max(from, free.from), std::min(to, free.to)};
}

/// How much of a line is wet, in pieces, whose points have above(n): see wet_part().
template <class Above>
double wet_length(const LevelLine& line, const Above& above) {
  double wet = 0, here = above(0);
  for (std::size_t n = 0; n < line.pieces.size(); ++n) {
    const double next = above(n + 1);
    const LevelPiece part = wet_part(here, next, line.pieces[n]);
    wet += std::max(part.to - part.from, 0.0);
    here = next;
  }
  return wet;
}

/// The same up to the first dry stretch outside of obstacles that is longer than `gap` (pieces).
/// `backward`: from the last point on.
template <class Above>
double connected_length(const LevelLine& line, const Above& above, double gap, bool backward) {
  double wet = 0, dry = 0;
  const std::size_t count = line.pieces.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t n = backward ? count - 1 - k : k;
    LevelPiece free = line.pieces[n], part = wet_part(above(n), above(n + 1), free);
    if (backward) free = {1 - free.to, 1 - free.from}, part = {1 - part.to, 1 - part.from};
    const double open = std::max(free.to - free.from, 0.0);
    const double length = std::max(part.to - part.from, 0.0);
    dry += length > 0 ? part.from - free.from : open;
    if (dry > gap) break;
    if (length > 0) wet += length, dry = free.to - part.to;
  }
  return wet;
}

}  // namespace pbf::program_module
