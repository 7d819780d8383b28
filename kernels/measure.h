// A measurement over all particles, and the share of one particle in it; in double on every backend
// and in both precisions. Its results do not depend on the order of particles, on threads, blocks
// or backends: maxima and counts come first, then sums of integers (fixed_sum.h) in units that
// follow from the maxima.
#pragma once

#include <cstdint>

#include "kernels/fixed_sum.h"
#include "kernels/params.h"
#include "kernels/step_counts.h"

namespace pbf {

/// The pool in which all the fluid would rest: on the wall that gravity points at, between walls on
/// all four sides. axis -1: the scene has no such pool.
struct RestPool {
  int axis = -1;
  double floor = 0, up = 1;  ///< h, coordinate of the floor; +1 or -1, away from it
  double depth = 0;          ///< h, volume of the fluid over the floor's area
  double spacing = 0;        ///< h, of the rest lattice
};

/// What a measurement needs from the scene, in the internal frame.
struct MeasureConstants {
  RestPool rest;
};

/// Maxima and counts, in the internal frame (h, s, rho0).
struct MeasureCounts {
  double compression_max = 0, speed_squared_max = 0;
  double x_size[3] = {0, 0, 0}, v_size[3] = {0, 0, 0};  ///< largest magnitudes
  double front[3] = {-1e300, -1e300, -1e300};
  double penetration = 0;  ///< largest distance behind the limit where particles are clamped
  std::int64_t above_1 = 0, above_10 = 0;  ///< particles compressed by more than 1 %, 10 %
  std::int64_t neighbors = 0, neighbors_max = 0, outside = 0, non_finite = 0;
  std::int64_t fast = 0, repeats = 0, unresolved = 0;  ///< StepCounts so far
  double way_squared = 0;                              ///< the same

  PBF_HD void add(const MeasureCounts& o) {
    const auto take_larger = [](auto& a, auto b) { a = a > b ? a : b; };
    take_larger(compression_max, o.compression_max);
    take_larger(speed_squared_max, o.speed_squared_max);
    for (int k = 0; k < 3; ++k) {
      take_larger(x_size[k], o.x_size[k]);
      take_larger(v_size[k], o.v_size[k]);
      take_larger(front[k], o.front[k]);
    }
    take_larger(penetration, o.penetration);
    above_1 += o.above_1;
    above_10 += o.above_10;
    neighbors += o.neighbors;
    take_larger(neighbors_max, o.neighbors_max);
    outside += o.outside;
    non_finite += o.non_finite;
    fast += o.fast;
    repeats += o.repeats;
    unresolved += o.unresolved;
    take_larger(way_squared, o.way_squared);
  }
};
/// What the steps have counted.
PBF_HD MeasureCounts counts_of(const StepCounts& steps) {
  MeasureCounts s;
  s.fast = std::int64_t(steps.fast);
  s.repeats = std::int64_t(steps.repeats);
  s.unresolved = std::int64_t(steps.unresolved);
  s.way_squared = steps.way_squared;
  return s;
}

/// Exponents of the units: every term of a quantity is below 2^e.
struct MeasureUnits {
  int compression = 0, speed_squared = 0, x[3] = {0, 0, 0}, v[3] = {0, 0, 0};
  MeasureUnits() = default;
  PBF_HD explicit MeasureUnits(const MeasureCounts& c)
      : compression(exponent_above(c.compression_max)),
        speed_squared(exponent_above(c.speed_squared_max)) {
    for (int k = 0; k < 3; ++k) {
      x[k] = exponent_above(c.x_size[k]);
      v[k] = exponent_above(c.v_size[k]);
    }
  }
};

/// The sums in these units; squares of compressions in the square of their unit.
struct MeasureTerms {
  /// Particles below each eighth of the depth at rest (RestPool), each spread over a spacing.
  static constexpr int levels = 8;
  FixedSum compression, compression_squared, speed_squared, x[3], v[3], below[levels];

  PBF_HD void add(const MeasureTerms& o) {
    compression.add(o.compression);
    compression_squared.add(o.compression_squared);
    speed_squared.add(o.speed_squared);
    for (int k = 0; k < 3; ++k) {
      x[k].add(o.x[k]);
      v[k].add(o.v[k]);
    }
    for (int k = 0; k < levels; ++k) below[k].add(o.below[k]);
  }
};

/// All results as numbers; lib/solver/diagnostics.cpp converts them to SI units.
struct MeasureSums : MeasureCounts {
  static constexpr int levels = MeasureTerms::levels;
  double compression = 0, compression_squared = 0, speed_squared = 0;
  double x[3] = {0, 0, 0}, v[3] = {0, 0, 0}, below[levels] = {0, 0, 0, 0, 0, 0, 0, 0};
  double compression_p99 = 0;  ///< from the histogram (compression_bins.h)

  MeasureSums() = default;
  MeasureSums(const MeasureCounts& c, const MeasureTerms& t) : MeasureCounts(c) {
    const MeasureUnits unit(c);
    compression = value_of(t.compression, unit.compression);
    compression_squared = value_of(t.compression_squared, 2 * unit.compression);
    speed_squared = value_of(t.speed_squared, unit.speed_squared);
    for (int k = 0; k < 3; ++k) {
      x[k] = value_of(t.x[k], unit.x[k]);
      v[k] = value_of(t.v[k], unit.v[k]);
    }
    for (int k = 0; k < levels; ++k) below[k] = value_of(t.below[k], 0);
  }
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// One particle's maxima and counts, then its terms. A non-finite particle counts as such and
/// nowhere else.
template <class Real, class Lists, class Boundary>
struct MeasurePass {
  Params<Real> p;
  Boundary boundary;
  Lists lists;
  const Vec4<Real>*position, *velocity;
  const Real* density;
  const StepCounts* step_counts;
  MeasureConstants given;

  PBF_HD MeasureCounts counts(int i) const {
    MeasureCounts s;
    if (i == 0) s = of_steps();
    if (!finite(i)) {
      s.non_finite = 1;
      return s;
    }
    const Particle a = particle(i);
    s.compression_max = a.compression;
    s.speed_squared_max = a.speed_squared;
    for (int k = 0; k < 3; ++k) {
      s.front[k] = a.x[k] + 0.0;  // turns -0 into 0, so that maxima do not depend on the order
      s.x_size[k] = a.x[k] < 0 ? -a.x[k] : a.x[k];
      s.v_size[k] = a.v[k] < 0 ? -a.v[k] : a.v[k];
    }
    s.above_1 = a.compression > 0.01 ? 1 : 0;
    s.above_10 = a.compression > 0.1 ? 1 : 0;
    s.penetration = boundary.penetration(a.x);
    s.outside = p.boundary.beyond(a.x) ? 1 : 0;
    s.neighbors = s.neighbors_max = lists.size(i);
    return s;
  }

  /// What row 0 counts besides its particle.
  PBF_HD MeasureCounts of_steps() const { return counts_of(*step_counts); }

  PBF_HD MeasureTerms terms(int i, const MeasureUnits& unit) const {
    MeasureTerms s;
    if (!finite(i)) return s;
    const Particle a = particle(i);
    const double c = a.compression * power_of_two(-unit.compression);
    s.compression = fixed_term(c);
    s.compression_squared = fixed_term(c * c);
    s.speed_squared = fixed_term(a.speed_squared * power_of_two(-unit.speed_squared));
    for (int k = 0; k < 3; ++k) {
      s.x[k] = fixed_term(a.x[k] * power_of_two(-unit.x[k]));
      s.v[k] = fixed_term(a.v[k] * power_of_two(-unit.v[k]));
    }
    if (given.rest.axis < 0) return s;
    const double height = given.rest.up * (a.x[given.rest.axis] - given.rest.floor);
    for (int k = 0; k < MeasureTerms::levels; ++k) {
      const double level = given.rest.depth * (k + 1) / MeasureTerms::levels;
      s.below[k] = fixed_term(max2((level - height) / given.rest.spacing + 0.5, 0.0));  // at most 1
    }
    return s;
  }

 private:
  struct Particle {
    double x[3], v[3], compression, speed_squared;
  };
  PBF_HD bool finite(int i) const {
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    return is_finite(x.x + x.y + x.z) && is_finite(dot(v, v)) && is_finite(density[i]);
  }
  PBF_HD Particle particle(int i) const {
    const Vec4<Real>&x = position[i], &v = velocity[i];
    Particle a{{x.x, x.y, x.z}, {v.x, v.y, v.z}, max2(double(density[i]) - 1, 0.0), 0};
    a.speed_squared = a.v[0] * a.v[0] + a.v[1] * a.v[1] + a.v[2] * a.v[2];
    return a;
  }
};

}  // namespace pbf::PBF_VARIANT
