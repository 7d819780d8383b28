#include "lib/run/overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "lib/run/body_boxes.h"

namespace pbf::run_module {
namespace {

constexpr std::int64_t kMostDistances = 200000000;

using Cell = std::array<std::int64_t, 3>;

struct Candidate {
  Cell cell;
  std::size_t body;
  Double3 x;
};

std::vector<BodyBox> boxes_of(const Scene& s, const StartPoints& points) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<BodyBox> boxes(s.bodies.size(), {{far, far, far}, {-far, -far, -far}});
  points.for_each([&](std::size_t b, const Double3& x) { boxes[b].add({x, x}); });
  return boxes;
}

/// For each body, the bodies whose boxes are within `reach`.
using Near = std::vector<std::vector<std::size_t>>;

Near near_bodies(const std::vector<BodyBox>& boxes, double reach) {
  Near near(boxes.size());
  any_near_pair(boxes, reach * (1 + 1e-6), [&](std::size_t i, std::size_t j) {
    near[i].push_back(j);
    near[j].push_back(i);
    return false;
  });
  return near;
}

std::vector<Candidate> candidates(const Scene& s, const StartPoints& points,
                                  const std::vector<BodyBox>& boxes, const Near& others,
                                  double reach) {
  std::vector<Candidate> out;
  points.for_each([&](std::size_t b, const Double3& x) {
    const bool near = s.bodies[b].shape == Shape::file ||
                      std::any_of(others[b].begin(), others[b].end(),
                                  [&](std::size_t k) { return boxes[k].holds(x, reach); });
    if (!near) return;
    Cell c{};
    for (int a = 0; a < 3; ++a)
      c[a] = static_cast<std::int64_t>(std::floor((x[a] - s.domain.min[a]) / reach));
    out.push_back({c, b, x});
  });
  std::sort(out.begin(), out.end(),
            [](const Candidate& a, const Candidate& b) { return a.cell < b.cell; });
  return out;
}

}  // namespace

Overlap find_overlap(const StartPoints& points) {
  const Scene& s = points.scene();
  Overlap found;
  const bool file = std::any_of(s.bodies.begin(), s.bodies.end(),
                                [](const Body& b) { return b.shape == Shape::file; });
  if (s.bodies.size() < 2 && !file) return found;
  // Less by more than rounding: bodies that touch on one lattice are a full spacing apart.
  const double reach = 0.5 * s.fluid.spacing * (1 - 1e-6);
  if (!file && !any_near_bodies(s, reach)) return found;  // by their shapes alone
  const std::vector<BodyBox> boxes = boxes_of(s, points);
  const Near others = near_bodies(boxes, reach);
  const std::vector<Candidate> list = candidates(s, points, boxes, others, reach);
  for (const Candidate& c : list) found.of_files += s.bodies[c.body].shape == Shape::file;
  const auto bodies = [&](std::size_t a, std::size_t b) {
    if (found.inside + found.pairs > 1) return;
    found.first = std::min(a, b);
    found.second = std::max(a, b);
  };
  for (const Candidate& c : list)
    for (const std::size_t k : others[c.body])
      // By more than rounding. If bodies only touch, the particles of one are half a spacing
      // outside the other.
      if (is_in(s.bodies[k], c.x, -1e-6 * s.fluid.spacing)) {
        ++found.inside;
        bodies(k, c.body);
        break;
      }
  std::int64_t distances = 0;
  const auto look = [&](const Candidate& a, const Candidate& b) {
    ++distances;
    if (a.body == b.body && s.bodies[a.body].shape != Shape::file) return;
    double r2 = 0;
    for (int k = 0; k < 3; ++k) r2 += (a.x[k] - b.x[k]) * (a.x[k] - b.x[k]);
    if (!(r2 < reach * reach)) return;
    if (a.body == b.body) {
      if (found.within++ == 0) found.file = a.body;
    } else {
      ++found.pairs;
      bodies(a.body, b.body);
    }
  };
  // Visits the own cell from this particle on and half of the adjacent ones: each pair once.
  const auto first_in = [&](const Cell& c) {
    return std::lower_bound(list.begin(), list.end(), c,
                            [](const Candidate& a, const Cell& cell) { return a.cell < cell; });
  };
  for (auto i = list.begin(); i != list.end(); ++i)
    for (int dx = 0; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          if (Cell{dx, dy, dz} < Cell{}) continue;
          const Cell c{i->cell[0] + dx, i->cell[1] + dy, i->cell[2] + dz};
          for (auto j = c == i->cell ? i + 1 : first_in(c); j != list.end() && j->cell == c; ++j)
            if (look(*i, *j); distances >= kMostDistances) return found.more = true, found;
        }
  return found;
}

}  // namespace pbf::run_module
