// Statistics of particles that chaos does not change, and distances of distributions.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/snapshot.h"

namespace pbf::verify_module {

/// One number of a frame.
struct Statistic {
  std::string name, unit;
  double value = 0;
  /// Sampling uncertainty, kSigmas standard errors: for a mean std/sqrt(n), for a quantile the
  /// order statistics at p +- kSigmas sqrt(p (1 - p)/n), or twice the lower difference if the
  /// sample ends before the upper one.
  double uncertainty = 0;
  /// Reference for rounding if it is more than |value|: for the mean of a component of a vector the
  /// mean length, because rounding does not depend on the orientation of the axes.
  double scale = 0;
  double resolution = 0;  ///< smaller differences are ignored, from a caller's Resolution
};

/// Five standard errors: one false alarm in 1.7 million for a mean.
inline constexpr double kSigmas = 5;

/// A quantity of all particles, sorted.
struct Distribution {
  std::string name, unit;
  std::vector<double> values;
  double resolution = 0;  ///< as in Statistic
  double samples = 0;     ///< effective number of independent samples
};

/// Differences between frames that are too small to count: how far rounding alone can change the
/// values of a particle.
struct Resolution {
  double length = 0;   ///< m, for a coordinate
  double speed = 0;    ///< m/s, for a component of the velocity
  double density = 0;  ///< for rho/rho0
  double front = 0;    ///< m, added for a front, which is the position of one particle
  /// m: particles closer than this are at a front together and share velocity and density; 0: all
  /// are independent.
  double cluster = 0;
  /// Chaos has mixed the particles: those that share a velocity or density, if the frame shows that
  /// they do (Clusters), count as one sample.
  bool mixed = true;
};

/// Values of a floating-point field.
std::vector<double> numbers_of(const FieldArray& f);

struct FrameStatistics {
  std::vector<Statistic> numbers;
  std::vector<Distribution> distributions;
};

/// Of a snapshot with at least "position"; statistics of missing fields are left out. Positions are
/// relative to `origin`. Per mass: energies in J/kg, momentum in m/s.
FrameStatistics frame_statistics(const Snapshot& snapshot, const Double3& origin,
                                 const Double3& gravity, double rest_density,
                                 const Resolution& resolution = {});

/// Largest distance of the empirical distribution functions of two sorted samples, 0..1
/// (Kolmogorov-Smirnov). NaN counts as the largest value. Values that differ by at most `rounding`
/// count as equal: the result is the smallest distance after such changes.
double ks_distance(const std::vector<double>& a, const std::vector<double>& b, double rounding = 0);

/// The distance that two samples of sizes n and m from one distribution exceed with probability
/// alpha: sqrt(-ln(alpha/2)/2 (n + m)/(n m)) (Smirnov 1948).
double ks_critical(double alpha, double n, double m);

/// Least-squares fit of ln y = c + x/e to the points with 0 < y < upper. Returns e, or 0 with fewer
/// than 3 points or less than 1 % of growth.
double e_folding(const std::vector<double>& x, const std::vector<double>& y, double upper);

/// Particles grouped by the cells of three grids, for the effective number of independent samples
/// of particles that move together: in small groups, or in waves of the tank.
class Clusters {
 public:
  /// `position`: 3 coordinates per particle, m; `edge` of a cell of the finest grid, m, twice and
  /// four times as long in the others; 0: all particles independent.
  Clusters(const std::vector<double>& position, double edge);

  /// Ratio of the variance of a mean to that for independent particles (Kish's design effect): sum
  /// over cells of (sum of r)^2 over sum of r^2, with r = value - mean; the largest of the grids,
  /// at least 1. In too small cells it would be too small, as neighboring cells move together
  /// (Flyvbjerg & Petersen 1989, Error estimates on averages of correlated data).
  double design_effect(const std::vector<double>& values) const;

  /// Mean number of particles in the cells of the finest grid that hold any; 1 without cells.
  double mean_size() const;

  /// The largest design effect of the fractions of particles below five quantiles of `values`;
  /// `sorted`: the same values sorted, NaN last.
  double design_effect_of_shares(const std::vector<double>& values,
                                 const std::vector<double>& sorted) const;

 private:
  struct Grid {
    std::vector<std::size_t> cell;  // per particle
    std::size_t cells = 0;
  };
  std::vector<Grid> grids_;  // empty: all particles independent
};

}  // namespace pbf::verify_module
