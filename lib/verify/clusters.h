// Estimates the effective number of independent samples of particles that move together.
#pragma once

#include <vector>

#include "lib/scene/scene.h"

namespace pbf::verify_module {

/// Particles grouped by cells of a grid.
class Clusters {
 public:
  /// `position`: 3 coordinates per particle, m; `edge` of a cell, m; 0: all particles independent.
  Clusters(const std::vector<double>& position, double edge);

  /// Ratio of the variance of a mean to that for independent particles (Kish's design effect): sum
  /// over cells of (sum of r)^2 over sum of r^2, with r = value - mean; at least 1.
  double design_effect(const std::vector<double>& values) const;

  /// The largest design effect of the fractions of particles below five quantiles of `values`;
  /// `sorted`: the same values sorted, NaN last.
  double design_effect_of_shares(const std::vector<double>& values,
                                 const std::vector<double>& sorted) const;

 private:
  std::vector<std::size_t> cell_;  // per particle; empty: all particles independent
  std::size_t cells_ = 0;
};

}  // namespace pbf::verify_module
