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
  owner_.assign(std::size_t(layers), 0);
  int at = 0;
  for (int r = 1; r <= ranks_; ++r) {
    const double share = double(below.back()) * r / ranks_;
    const int least = at + 1, most = units - (ranks_ - r);
    const auto distance = [&](int u) { return std::abs(double(below[std::size_t(u)]) - share); };
    for (at = least; at < most && (r == ranks_ || distance(at + 1) <= distance(at)); ++at) {
    }
    const int from = cut_.back(), to = std::min(at * unit_, layers);
    std::fill(owner_.begin() + from, owner_.begin() + to, r - 1);
    cut_.push_back(to);
  }
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
  if (double(most_) <= 1.01 * double(all) / ranks_) return false;
  Slabs other = *this;
  other.cut(in_layer);
  other.most_ = other.most(in_layer);
  const bool better = other.most_ < most_;
  if (better) *this = other;
  return better;
}

}  // namespace pbf::exec_module
