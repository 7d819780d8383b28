#include "lib/exec/ranks/slabs.h"

#include <fmt/core.h>
#include <algorithm>
#include <numeric>

#include "lib/base/error.h"

namespace pbf::exec_module {

Slabs::Slabs(const std::vector<std::int64_t>& in_layer, int ranks, int unit)
    : ranks_(ranks), unit_(unit) {
  const int units = (int(in_layer.size()) + unit - 1) / unit;
  if (units < ranks)
    throw Error(ExitCode::bad_input,
                fmt::format("the box has {} layers of {} along its longest edge, too few for {} "
                            "ranks; start at most {} ranks",
                            units, unit == 1 ? "cells" : "cells that solver.levels keeps together",
                            ranks, units));
  cut(in_layer);
  most_ = most(in_layer);
}

/// Each cut where the particles below are nearest to its share, and leaves a unit to every rank.
void Slabs::cut(const std::vector<std::int64_t>& in_layer) {
  const int layers = int(in_layer.size()), units = (layers + unit_ - 1) / unit_;
  std::vector<std::int64_t> below(std::size_t(units) + 1);
  for (int l = 0; l < layers; ++l) below[std::size_t(l / unit_) + 1] += in_layer[std::size_t(l)];
  std::partial_sum(below.begin(), below.end(), below.begin());
  cut_.assign(1, 0);
  int at = 0;
  for (int r = 1; r <= ranks_; ++r) {
    const double share = double(below.back()) * r / ranks_;
    const int least = at + 1, most = units - (ranks_ - r);
    const auto distance = [&](int u) { return std::abs(double(below[std::size_t(u)]) - share); };
    for (at = least; at < most && (r == ranks_ || distance(at + 1) <= distance(at)); ++at) {
    }
    cut_.push_back(std::min(at * unit_, layers));
  }
  own();
}

void Slabs::own() {
  owner_.assign(std::size_t(cut_.back()), 0);
  for (int r = 0; r < ranks_; ++r) std::fill(owner_.begin() + low(r), owner_.begin() + high(r), r);
}

/// Each cut goes towards the other one by units, and stays above the one before.
void Slabs::approach(const std::vector<int>& cuts, const std::vector<std::int64_t>& in_layer,
                     std::int64_t most_moved) {
  for (std::size_t r = 1; r + 1 < cut_.size(); ++r) {
    int& at = cut_[r];
    const int to = cuts[r], step = to > at ? unit_ : -unit_;
    std::int64_t moved = 0;
    for (bool first = true; at != to; first = false, at += step) {
      const auto from = in_layer.begin() + std::min(at, at + step);
      moved += std::accumulate(from, from + unit_, std::int64_t(0));
      if (!first && moved > most_moved) break;
    }
    at = std::max(at, cut_[r - 1] + unit_);
  }
  unfinished_ = cut_ != cuts;
  own();
}

std::int64_t Slabs::most(const std::vector<std::int64_t>& in_layer) const {
  std::int64_t most = 0;
  for (int r = 0; r < ranks_; ++r)
    most = std::max(most, std::accumulate(in_layer.begin() + low(r), in_layer.begin() + high(r),
                                          std::int64_t(0)));
  return most;
}

bool Slabs::balance(const std::vector<std::int64_t>& in_layer) {
  const auto all = std::accumulate(in_layer.begin(), in_layer.end(), std::int64_t(0));
  most_ = most(in_layer);
  unfinished_ = false;
  if (double(most_) <= 1.01 * double(all) / ranks_) return false;
  Slabs other = *this;
  other.cut(in_layer);
  if (other.most(in_layer) >= most_) return false;
  approach(other.cut_, in_layer, all / (25 * ranks_));
  most_ = most(in_layer);
  return true;
}

}  // namespace pbf::exec_module
