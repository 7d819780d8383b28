// Particles that move together are not independent samples: estimates the effective number.
#pragma once

#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline verify_module {

/// Particles by the cell of a grid that they lie in.
class Clusters {
 public:
  /// `position`: 3 coordinates each, m; `edge` of a cell, m; 0: every particle by itself.
  Clusters(const std::vector<double>& position, double edge);

  /// By how much the variance of a mean exceeds that of independent particles (Kish's design
  /// effect): sum over the cells of (sum of r)^2 over sum of r^2, r = value - mean; at least 1.
  double design_effect(const std::vector<double>& values) const;

  /// The largest design effect of the shares of particles below five quantiles of `values`;
  /// `sorted`: the same, NaN last.
  double design_effect_of_shares(const std::vector<double>& values,
                                 const std::vector<double>& sorted) const;

 private:
  std::vector<std::size_t> cell_;  // of each particle; empty: every particle by itself
  std::size_t cells_ = 0;
};

}  // namespace pbf::inline verify_module
