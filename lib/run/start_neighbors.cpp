#include "lib/run/start_neighbors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "lib/scene/body_box.h"
#include "lib/scene/random.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {
namespace {

/// Calls f(i, j) once for every pair of boxes that meet(), until it returns true. Returns whether a
/// call returned true.
template <class F>
bool any_near_pair(const std::vector<BodyBox>& boxes, double margin, F&& f) {
  Double3 extent{};
  for (const BodyBox& b : boxes)
    for (std::size_t a = 0; a < 3; ++a)
      extent[a] = std::max(extent[a], std::fabs(b.low[a] - boxes[0].low[a]));
  // Sorted along the axis of largest extent, a box can be near only to the next few boxes.
  const auto axis = std::size_t(std::ranges::max_element(extent) - extent.begin());
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return boxes[i].low[axis]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const BodyBox& a = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const BodyBox& b = boxes[order[j]];
      if (!(b.low[axis] < a.high[axis] + margin)) break;
      if (a.meets(b, margin) && f(order[i], order[j])) return true;
    }
  }
  return false;
}

/// Whether two bodies that are given by shapes are near each other.
bool any_near_bodies(const Scene& s, double margin) {
  std::vector<BodyBox> boxes;
  for (const Body& b : s.bodies) boxes.push_back(body_box(b));
  return any_near_pair(boxes, margin, [](std::size_t, std::size_t) { return true; });
}

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const Double3& x, double edge) {
  Cell c{};
  for (int a = 0; a < 3; ++a) c[a] = static_cast<std::int64_t>(std::floor(x[a] / edge));
  return c;
}

bool may_be_over_dense(const Scene& s) {
  for (const Body& b : s.bodies)
    if (b.shape == Shape::random_box || b.from_file()) return true;
  return any_near_bodies(s, -1e-6 * s.fluid.spacing);  // by more than rounding
}

/// Sampled particles in a hash of cells of edge h; each is in its own cell and the adjacent ones.
class Sample {
 public:
  explicit Sample(double h) : h_(h) {}
  void add(const Double3& x) {
    const int mine = int(at_.size());
    at_.push_back(x);
    const Cell c = cell_of(x, h_);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k)
          near_[key({c[0] + i, c[1] + j, c[2] + k})].push_back(mine);
  }
  /// Counts x as a neighbor of each sampled particle within h.
  void count(const Double3& x, std::vector<int>& neighbors) const {
    const auto found = near_.find(key(cell_of(x, h_)));
    if (found == near_.end()) return;
    for (const int s : found->second) {
      const Double3 r = x - at_[s];
      neighbors[s] += dot(r, r) < h_ * h_;
    }
  }
  std::size_t size() const { return at_.size(); }
  /// Per sample: the standard error of the mean count in its solver bin (an eighth of a cell).
  std::vector<double> scatter(const std::vector<int>& neighbors) const {
    struct Sums {
      double n = 0, sum = 0, squares = 0;
    };
    std::unordered_map<std::uint64_t, Sums> bins;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      Sums& s = bins[key(cell_of(at_[i], h_ / 2))];
      s.n += 1;
      s.sum += neighbors[i];
      s.squares += double(neighbors[i]) * neighbors[i];
    }
    std::vector<double> out(at_.size());
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const Sums& s = bins[key(cell_of(at_[i], h_ / 2))];
      if (s.n >= 4) out[i] = std::sqrt(std::max(0.0, s.squares - s.sum * s.sum / s.n) / (s.n - 1));
    }
    return out;
  }

 private:
  /// Cells that share a key cost only time, since distances decide. A particle would be counted
  /// twice if two of the 27 cells around it shared a key; with 2^21 cells per axis they do not.
  static std::uint64_t key(const Cell& c) {
    std::uint64_t k = 0;
    for (const std::int64_t i : c) k = k << 21 | (std::uint64_t(i) & 0x1FFFFF);
    return k;
  }

  double h_;
  std::vector<Double3> at_;
  std::unordered_map<std::uint64_t, std::vector<int>> near_;
};

// ----------------------------------------------------------------------------------- overlaps

constexpr std::int64_t kMostDistances = 200000000;

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
    const bool near = s.bodies[b].from_file() || std::ranges::any_of(others[b], [&](std::size_t k) {
                        return boxes[k].holds(x, reach);
                      });
    if (!near) return;
    out.push_back({cell_of(x - s.domain.min, reach), b, x});
  });
  std::ranges::sort(out, {}, &Candidate::cell);
  return out;
}

}  // namespace

StartNeighbors start_neighbors(const StartPoints& points, std::int64_t particles) {
  const Scene& s = points.scene();
  StartNeighbors out;
  if (!may_be_over_dense(s)) return out;
  for (std::size_t b = 0; b < s.bodies.size(); ++b)
    for (const Double3& x : points.of_file(b).position) out.of_files.add({x, x});
  // Fewer samples for many particles: in one clump every particle is tested with every sample.
  const std::int64_t wanted =
      std::min(particles, std::clamp<std::int64_t>(400000000 / particles, 256, 4096));
  // One particle from each of `wanted` ranges of ids, at a random index: with equal strides all
  // could lie on one face of a lattice.
  SplitMix64 random(1);
  Sample sample(s.h());
  const auto first_of = [&](std::int64_t k) { return k * particles / wanted; };
  const auto draw = [&](std::int64_t k) {
    const std::int64_t run = first_of(k + 1) - first_of(k);
    return first_of(k) + std::min(run - 1, std::int64_t(random.uniform() * double(run)));
  };
  std::int64_t id = 0, k = 0, next = draw(0);
  points.for_each([&](std::size_t, const Double3& x) {
    if (id++ != next) return;
    sample.add(x);
    if (++k < wanted) next = draw(k);
  });
  out.count.resize(sample.size());
  points.for_each([&](std::size_t, const Double3& x) { sample.count(x, out.count); });
  out.scatter = sample.scatter(out.count);
  return out;
}

Overlap find_overlap(const StartPoints& points) {
  const Scene& s = points.scene();
  Overlap found;
  const bool file = std::ranges::any_of(s.bodies, &Body::from_file);
  if (s.bodies.size() < 2 && !file) return found;
  // Less by more than rounding: bodies that touch on one lattice are a full spacing apart.
  const double reach = 0.5 * s.fluid.spacing * (1 - 1e-6);
  if (!file && !any_near_bodies(s, reach)) return found;  // by their shapes alone
  const std::vector<BodyBox> boxes = boxes_of(s, points);
  const Near others = near_bodies(boxes, reach);
  const std::vector<Candidate> list = candidates(s, points, boxes, others, reach);
  for (const Candidate& c : list) found.of_files += s.bodies[c.body].from_file();
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
    if (a.body == b.body && !s.bodies[a.body].from_file()) return;
    const Double3 r = a.x - b.x;
    if (!(dot(r, r) < reach * reach)) return;
    if (a.body == b.body) {
      if (found.within++ == 0) found.file = a.body;
    } else {
      ++found.pairs;
      bodies(a.body, b.body);
    }
  };
  // Visits the own cell from this particle on and half of the adjacent ones: each pair once.
  const auto first_in = [&](const Cell& c) {
    return std::ranges::lower_bound(list, c, {}, &Candidate::cell);
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
