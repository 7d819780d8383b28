// Particles as samples: numbers that chaos leaves alone, and the distance of two distributions.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/snapshot.h"

namespace pbf {

/// One number of a frame.
struct Statistic {
  std::string name, unit;
  double value = 0;
  /// What the choice of the particles leaves open, at kSigmas standard errors: of a mean
  /// std/sqrt(n), of a quantile the order statistics at p +- kSigmas sqrt(p (1 - p)/n).
  double uncertainty = 0;
};

/// Five standard errors: one false alarm in 1.7 million for a mean.
inline constexpr double kSigmas = 5;

/// One quantity of every particle, sorted.
struct Distribution {
  std::string name, unit;
  std::vector<double> values;
};

struct FrameStatistics {
  std::vector<Statistic> numbers;
  std::vector<Distribution> distributions;
};

/// Of a snapshot with at least "position"; what needs velocity or density is left out where these
/// are missing. Lengths are from `origin`. Per mass: energies in J/kg, momentum in m/s.
FrameStatistics frame_statistics(const Snapshot& snapshot, const Double3& origin,
                                 const Double3& gravity, double rest_density);

/// Largest distance of the empirical distribution functions of two sorted samples, 0..1
/// (Kolmogorov-Smirnov). NaN counts as the largest value.
double ks_distance(const std::vector<double>& a, const std::vector<double>& b);

/// The distance that two samples of sizes n and m of one distribution exceed with probability
/// alpha: sqrt(-ln(alpha/2)/2 (n + m)/(n m)) (Smirnov 1948).
double ks_critical(double alpha, std::size_t n, std::size_t m);

/// Least squares of ln y = c + x/e over the points with 0 < y < upper; e, or 0 where there are
/// fewer than 3 points or less than 1 % of growth.
double e_folding(const std::vector<double>& x, const std::vector<double>& y, double upper);

}  // namespace pbf
