#include "tests/oracle/n2_levels.h"

#include <algorithm>
#include <cmath>

namespace oracle {
namespace {

using Node = std::array<int, 3>;

/// One axis of all levels.
struct Axis {
  Real edge = 0, last = 0;     // m, of a cell and of the last one
  std::vector<int> intervals;  // of each level; 0: one node, whose hat is constant

  int nodes(int level) const { return intervals[std::size_t(level)] + 1; }
  int cell(Real x) const {
    return std::min(std::max(int(std::floor(x / edge)), 0), intervals[0] - 1);
  }
  /// Share of the hat of node i of the next level at node j of this one.
  Real hat(int level, int i, int j) const {
    if (intervals[std::size_t(level) + 1] == 0) return 1;
    return std::max<Real>(0, 1 - std::fabs(Real(j - 2 * i)) / 2);
  }
  /// Do the hats of node i of the next level and of node j of this one overlap?
  bool overlap(int level, int i, int j) const {
    return intervals[std::size_t(level) + 1] == 0 || std::abs(j - 2 * i) < 3;
  }
  Real length(int c) const { return c == intervals[0] - 1 ? last : edge; }
  /// Value and slope, in the middle of cell c, of the hat of node i of level 0.
  std::array<Real, 2> hat_in(int c, int i) const {
    if (intervals[0] == 0) return {1, 0};
    if (i == c) return {0.5L, -1 / length(c)};
    if (i == c + 1) return {0.5L, 1 / length(c)};
    return {0, 0};
  }
};

struct Sums {
  Real excess = 0, particles = 0;
  bool on = true;
  std::array<bool, 3> held{};  // by a wall across that axis
};

/// The cell that a particle is in; -1 beyond an open face.
Node cell_of(const std::array<Axis, 3>& axes, const V& at, const Settings& c) {
  Node cell{0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    if (at[k] < c.low[k] || at[k] > c.high[k]) return {-1, -1, -1};
    if (axes[k].intervals[0] > 0) cell[k] = axes[k].cell(at[k] - c.low[k]);
  }
  return cell;
}
/// Particles in it at rest.
Real full_cell(const std::array<Axis, 3>& axes, const Node& cell, const Settings& c) {
  Real full = 1;
  for (std::size_t k = 0; k < 3; ++k)
    if (axes[k].intervals[0] > 0) full *= axes[k].length(cell[k]) / c.spacing;
  return full;
}

/// m, of a place from an obstacle; 0 in it.
Real away(const Solid& o, const V& x, int dimensions) {
  V p{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t k = 0; k < 3; ++k)
      if (dimensions == 3 || k != 1) p[a] += o.axes[a][k] * (x[k] - o.center[k]);
  const auto beyond = [](Real r, Real half) { return std::max<Real>(std::fabs(r) - half, 0); };
  switch (o.shape) {
    case Solid::Shape::plane:
      return std::max<Real>(p[2], 0);
    case Solid::Shape::box:
      return std::hypot(beyond(p[0], o.half[0]), beyond(p[1], o.half[1]), beyond(p[2], o.half[2]));
    case Solid::Shape::sphere:
      return beyond(std::hypot(p[0], p[1], p[2]), o.half[0]);
    case Solid::Shape::cylinder:
      return std::hypot(beyond(std::hypot(p[0], p[1]), o.half[0]), beyond(p[2], o.half[2]));
    case Solid::Shape::capsule:
      return beyond(std::hypot(p[0], p[1], beyond(p[2], o.half[2])), o.half[0]);
  }
  return 0;
}
/// Whether an obstacle may reach into the cell: into the sphere around it.
bool reached(const std::array<Axis, 3>& axes, const Node& cell, const Settings& c,
             LevelNodes& found) {
  V middle = c.low;
  Real squares = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (axes[k].intervals[0] == 0) continue;
    const Real half = axes[k].length(cell[k]) / 2;
    middle[k] += cell[k] * axes[k].edge + half;
    squares += half * half;
  }
  Real nearest = 1e30L;
  for (const Solid& o : c.solids) nearest = std::min(nearest, away(o, middle, c.dimensions));
  found.touch = std::min(found.touch, std::fabs(nearest - std::sqrt(squares)) / c.h);
  found.reached += nearest < std::sqrt(squares);
  return nearest < std::sqrt(squares);
}

template <class F>
void for_each_node(const std::array<Axis, 3>& axes, int level, F&& f) {
  for (int z = 0; z < axes[2].nodes(level); ++z)
    for (int y = 0; y < axes[1].nodes(level); ++y)
      for (int x = 0; x < axes[0].nodes(level); ++x) f(Node{x, y, z});
}
std::size_t place(const std::array<Axis, 3>& axes, int level, const Node& n) {
  return std::size_t((n[2] * axes[1].nodes(level) + n[1]) * axes[0].nodes(level) + n[0]);
}

std::array<Axis, 3> make_axes(const Settings& c) {
  std::array<Axis, 3> axes;
  for (int k = 0; k < 3; ++k) {
    Axis& a = axes[std::size_t(k)];
    const Real box = c.high[k] - c.low[k];
    const bool absent = c.dimensions == 2 && k == 1;
    a.edge = 2 * c.h;
    a.intervals = {absent ? 0 : std::max(1, int(std::round(box / a.edge)))};
    a.last = box - a.edge * (a.intervals[0] - 1);
  }
  const auto wide = [&] {
    return std::any_of(axes.begin(), axes.end(), [](auto& a) { return a.intervals.back() > 1; });
  };
  while (wide())
    for (Axis& a : axes) {
      const int n = a.intervals.back();
      a.intervals.push_back(n == 1 ? 0 : (n + 1) / 2);
    }
  return axes;
}

/// Sums at the nodes of level 0.
std::vector<Sums> finest(const std::array<Axis, 3>& axes, const std::vector<Node>& home,
                         const std::vector<Real>& ratio, const Settings& c, LevelNodes& found) {
  const auto touches = [&](int k, int node, int cell) {
    const Axis& a = axes[std::size_t(k)];
    return a.intervals[0] == 0 || cell == node || cell == node - 1;
  };
  Node cells;
  for (std::size_t k = 0; k < 3; ++k) cells[k] = std::max(axes[k].intervals[0], 1);
  std::vector<Sums> nodes(std::size_t(axes[0].nodes(0) * axes[1].nodes(0) * axes[2].nodes(0)));
  for (int cz = 0; cz < cells[2]; ++cz)
    for (int cy = 0; cy < cells[1]; ++cy)
      for (int cx = 0; cx < cells[0]; ++cx) {
        const Node cell{cx, cy, cz};
        Sums s;
        for (std::size_t i = 0; i < home.size(); ++i) {
          if (home[i] != cell) continue;
          s.particles += 1;
          s.excess += std::min<Real>(ratio[i] - 1, 0.05L);
        }
        const Real full = full_cell(axes, cell, c);
        found.closest = std::min(found.closest, std::fabs(s.particles - full / 2));
        const bool good = s.particles >= full / 2 && !reached(axes, cell, c, found);
        for_each_node(axes, 0, [&](const Node& n) {
          for (int k = 0; k < 3; ++k)
            if (!touches(k, n[std::size_t(k)], cell[std::size_t(k)])) return;
          Sums& node = nodes[place(axes, 0, n)];
          node.excess += s.excess;
          node.particles += s.particles;
          node.on = node.on && good;
        });
      }
  for_each_node(axes, 0, [&](const Node& n) {
    Sums& node = nodes[place(axes, 0, n)];
    for (std::size_t k = 0; k < 3; ++k) {
      const int last = axes[k].intervals[0];
      if (last == 0) continue;
      if (n[k] == 0 && c.open[2 * k]) node.on = false;
      if (n[k] == last && c.open[2 * k + 1]) node.on = false;
      node.held[k] = n[k] == 0 || n[k] == last;
    }
    if (!node.on) node.held = {};
    ++(node.on ? found.on : found.off);
  });
  return nodes;
}

/// |what all neighbors do to a particle whose multiplier's gradient is 1|, on the rest lattice.
Real lattice_answer(const Settings& c) {
  const int reach = int(std::ceil(c.h / c.spacing)), y_reach = c.dimensions == 2 ? 0 : reach;
  V sum{};
  for (int i = -reach; i <= reach; ++i)
    for (int j = -y_reach; j <= y_reach; ++j)
      for (int k = -reach; k <= reach; ++k) {
        if (i == 0 && j == 0 && k == 0) continue;
        const V d{i * c.spacing, j * c.spacing, k * c.spacing};
        const V g = spiky_gradient(d, c);
        for (int a = 0; a < 3; ++a) sum[a] += c.mass / c.rest_density * g[a] * d[a];
      }
  return std::fabs(sum[0] + sum[1] + sum[2]) / c.dimensions;
}

}  // namespace

std::vector<V> level_moves(const std::vector<V>& in_cell, const std::vector<Real>& ratio,
                           const Settings& c, LevelNodes& found) {
  const std::array<Axis, 3> axes = make_axes(c);
  found = {};
  found.levels = int(axes[0].intervals.size());
  std::vector<Node> home;
  for (const V& at : in_cell) home.push_back(cell_of(axes, at, c));
  const auto hat = [&](int level, const Node& coarse, const Node& fine) {
    Real w = 1;
    for (std::size_t k = 0; k < 3; ++k) w *= axes[k].hat(level, coarse[k], fine[k]);
    return w;
  };
  std::vector<std::vector<Sums>> sums{finest(axes, home, ratio, c, found)};
  for (int l = 0; l + 1 < found.levels; ++l) {
    std::vector<Sums> next;
    for_each_node(axes, l + 1, [&](const Node& coarse) {
      Sums s;
      for_each_node(axes, l, [&](const Node& fine) {
        const Real w = hat(l, coarse, fine);
        const Sums& f = sums.back()[place(axes, l, fine)];
        s.excess += w * f.excess;
        s.particles += w * f.particles;
        s.on = s.on && (w == 0 || f.on);
        for (std::size_t k = 0; k < 3; ++k) s.held[k] = s.held[k] || (w > 0 && f.held[k]);
      });
      if (!s.on) s.held = {};
      next.push_back(s);
    });
    sums.push_back(next);
  }
  std::vector<Real> multiplier, coarser;  // m^2
  for (int l = found.levels; l-- > 0;) {
    coarser.swap(multiplier);
    multiplier.clear();
    for_each_node(axes, l, [&](const Node& n) {
      Sums& s = sums[std::size_t(l)][place(axes, l, n)];
      const Real edge = 2 * c.h * powl(2, l), beta = 0.25L;
      Real k = s.on && s.particles > 0
                   ? beta * edge * edge * std::max<Real>(0, s.excess / s.particles)
                   : 0;
      if (l + 1 < found.levels)
        for_each_node(axes, l + 1, [&](const Node& coarse) {
          k += hat(l, coarse, n) * coarser[place(axes, l + 1, coarse)];
          const Sums& other = sums[std::size_t(l) + 1][place(axes, l + 1, coarse)];
          for (std::size_t a = 0; a < 3; ++a) {
            bool both = true;
            for (std::size_t b = 0; b < 3; ++b) both = both && axes[b].overlap(l, coarse[b], n[b]);
            s.held[a] = s.held[a] || (both && other.held[a]);
          }
        });
      multiplier.push_back(k);
    });
  }
  const Real gamma = lattice_answer(c);
  std::vector<V> moves;
  for (const Node& cell : home) {
    V move{};
    if (cell[0] < 0) {
      moves.push_back(move);
      continue;
    }
    Real inside = 0;
    for (const Node& other : home) inside += other == cell ? 1 : 0;
    std::array<bool, 3> held{};
    for_each_node(axes, 0, [&](const Node& n) {
      std::array<std::array<Real, 2>, 3> h;
      for (std::size_t k = 0; k < 3; ++k) h[k] = axes[k].hat_in(cell[k], n[k]);
      const Real k = -gamma * multiplier[place(axes, 0, n)];
      move[0] += k * h[0][1] * h[1][0] * h[2][0];
      move[1] += k * h[0][0] * h[1][1] * h[2][0];
      move[2] += k * h[0][0] * h[1][0] * h[2][1];
      if (h[0][0] * h[1][0] * h[2][0] > 0)
        for (std::size_t a = 0; a < 3; ++a) held[a] = held[a] || sums[0][place(axes, 0, n)].held[a];
    });
    for (int a = 0; a < 3; ++a)
      if (!held[std::size_t(a)]) move[a] *= full_cell(axes, cell, c) / inside, ++found.free;
    moves.push_back(move);
  }
  return moves;
}

}  // namespace oracle
