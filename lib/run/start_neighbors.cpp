#include "lib/run/start_neighbors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "lib/run/body_boxes.h"
#include "lib/scene/random.h"

namespace pbf::run_module {
namespace {

bool may_be_over_dense(const Scene& s) {
  for (const Body& b : s.bodies)
    if (b.shape == Shape::random_box || b.shape == Shape::file) return true;
  return any_near_bodies(s, -1e-6 * s.fluid.spacing);  // by more than rounding
}

/// Sampled particles in a hash of cells of edge h; each is in its own cell and the adjacent ones.
class Sample {
 public:
  explicit Sample(double h) : h_(h) {}
  void add(const Double3& x) {
    const int mine = int(at_.size());
    at_.push_back(x);
    const std::array<std::int64_t, 3> c = cell(x, h_);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k)
          near_[key({c[0] + i, c[1] + j, c[2] + k})].push_back(mine);
  }
  /// Counts x as a neighbor of each sampled particle within h.
  void count(const Double3& x, std::vector<int>& neighbors) const {
    const auto found = near_.find(key(cell(x, h_)));
    if (found == near_.end()) return;
    for (const int s : found->second) {
      double r2 = 0;
      for (int a = 0; a < 3; ++a) r2 += (x[a] - at_[s][a]) * (x[a] - at_[s][a]);
      neighbors[s] += r2 < h_ * h_;
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
      Sums& s = bins[key(cell(at_[i], h_ / 2))];
      s.n += 1;
      s.sum += neighbors[i];
      s.squares += double(neighbors[i]) * neighbors[i];
    }
    std::vector<double> out(at_.size());
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const Sums& s = bins[key(cell(at_[i], h_ / 2))];
      if (s.n >= 4) out[i] = std::sqrt(std::max(0.0, s.squares - s.sum * s.sum / s.n) / (s.n - 1));
    }
    return out;
  }

 private:
  std::array<std::int64_t, 3> cell(const Double3& x, double edge) const {
    std::array<std::int64_t, 3> c{};
    for (int a = 0; a < 3; ++a) c[a] = static_cast<std::int64_t>(std::floor(x[a] / edge));
    return c;
  }
  /// Cells that share a key cost only time, since distances decide. A particle would be counted
  /// twice if two of the 27 cells around it shared a key; with 2^21 cells per axis they do not.
  static std::uint64_t key(const std::array<std::int64_t, 3>& c) {
    std::uint64_t k = 0;
    for (const std::int64_t i : c) k = k << 21 | (std::uint64_t(i) & 0x1FFFFF);
    return k;
  }

  double h_;
  std::vector<Double3> at_;
  std::unordered_map<std::uint64_t, std::vector<int>> near_;
};

}  // namespace

StartNeighbors start_neighbors(const StartPoints& points, std::int64_t particles) {
  const Scene& s = points.scene();
  if (!may_be_over_dense(s)) return {};
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
  StartNeighbors out;
  out.count.resize(sample.size());
  points.for_each([&](std::size_t, const Double3& x) { sample.count(x, out.count); });
  out.scatter = sample.scatter(out.count);
  return out;
}

}  // namespace pbf::run_module
