// Particles as samples: quantities that chaos does not change, and distances of distributions.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/snapshot.h"

namespace pbf::inline verify_module {

/// One number of a frame.
struct Statistic {
  std::string name, unit;
  double value = 0;
  /// What the choice of the particles leaves open, at kSigmas standard errors: of a mean
  /// std/sqrt(n), of a quantile the order statistics at p +- kSigmas sqrt(p (1 - p)/n); twice the
  /// lower one where the sample ends before the upper.
  double uncertainty = 0;
  /// What rounding is relative to where that is more than |value|: for the mean of one component of
  /// a vector, the mean length, because a rotation of the axes changes no particle's rounding.
  double scale = 0;
  double resolution = 0;  ///< differences up to this are none, of a caller's Resolution
};

/// Five standard errors: one false alarm in 1.7 million for a mean.
inline constexpr double kSigmas = 5;

/// One quantity of every particle, sorted.
struct Distribution {
  std::string name, unit;
  std::vector<double> values;
  double resolution = 0;  ///< as of a Statistic
  double samples = 0;     ///< independent ones that `values` are worth
};

/// What is too small to tell two frames apart: how far rounding alone may move one particle's
/// values.
struct Resolution {
  double length = 0;   ///< m, of a coordinate
  double speed = 0;    ///< m/s, of a component of the velocity
  double density = 0;  ///< of rho/rho0
  double front = 0;    ///< m, of a front besides: it is the place of one particle
  /// m: particles nearer than that share velocity and density, so that they count as one sample as
  /// far as the frame shows that they do (Clusters); 0: all are independent.
  double cluster = 0;
};

/// Of a field of floating-point numbers.
std::vector<double> numbers_of(const FieldArray& f);

struct FrameStatistics {
  std::vector<Statistic> numbers;
  std::vector<Distribution> distributions;
};

/// Of a snapshot with at least "position"; what needs velocity or density is left out where these
/// are missing. Lengths are from `origin`. Per mass: energies in J/kg, momentum in m/s.
FrameStatistics frame_statistics(const Snapshot& snapshot, const Double3& origin,
                                 const Double3& gravity, double rest_density,
                                 const Resolution& resolution = {});

/// Largest distance of the empirical distribution functions of two sorted samples, 0..1
/// (Kolmogorov-Smirnov). NaN counts as the largest value. The smallest such distance of samples
/// whose values are moved by up to `rounding` in all: values not further apart count as equal.
double ks_distance(const std::vector<double>& a, const std::vector<double>& b, double rounding = 0);

/// The distance that two samples of sizes n and m of one distribution exceed with probability
/// alpha: sqrt(-ln(alpha/2)/2 (n + m)/(n m)) (Smirnov 1948).
double ks_critical(double alpha, double n, double m);

/// Least squares of ln y = c + x/e over the points with 0 < y < upper; e, or 0 where there are
/// fewer than 3 points or less than 1 % of growth.
double e_folding(const std::vector<double>& x, const std::vector<double>& y, double upper);

}  // namespace pbf::inline verify_module
