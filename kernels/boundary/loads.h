// What the fluid does to the walls around it: every displacement that a wall gives a particle is
// booked on that wall, in whole numbers, so that neither order nor threads change a sum.
#pragma once

#include <cstdint>

#include "kernels/atomics.h"
#include "kernels/boundary/moving.h"
#include "kernels/boundary/patch.h"
#include "kernels/vec3.h"

namespace pbf {

/// A wall's sum lies in so many parts, which different threads write.
inline constexpr int kLoadParts = 64;

/// Displacements are booked in so many parts of h.
inline constexpr std::int64_t kLoadUnits = std::int64_t(1) << 36;

/// What one wall got within an update, or a gauge on one: then way[0] alone, into the wall.
/// Displacements in units of h/kLoadUnits, with the sign of what the wall feels; moments about the
/// domain's lower corner in the same units times a power of two above the longest edge of the box.
struct LoadSums {
  std::int64_t way[3] = {0, 0, 0}, moment[3] = {0, 0, 0};
};

/// What one wall got since it was asked last, per mass of a particle, in the internal frame.
struct Load {
  double impulse[3] = {0, 0, 0};  ///< h/s
  /// h^2/s, about the domain's lower corner; of an obstacle that moves, about its middle.
  double moment[3] = {0, 0, 0};
  double peak = 0;  ///< h/s^2, largest mean force of one update
  double time = 0;  ///< s
  double work = 0;  ///< h^2/s^2, that an obstacle that moves has done
};

}  // namespace pbf

namespace pbf::inline PBF_VARIANT {

/// Where loads are booked.
template <class Real>
struct LoadBook {
  LoadSums* sums = nullptr;      ///< kLoadParts for each wall; null: there are none
  Real moment_scale = 1;         ///< 2^-e, 2^e above the longest edge of the box, h
  const Patch* patch = nullptr;  ///< pressure gauges
  int patches = 0;
  /// Bit of each wall whose own sums are wanted; those beyond the last bit have them.
  std::uint64_t summed = ~std::uint64_t(0);

  /// Whether those of the domain's walls are wanted, by themselves or by gauges.
  PBF_HD bool of_walls() const { return (summed & 63) != 0 || patches > 0; }

  /// Wall `wall` has moved particle i, which is at x, by `way` (h).
  PBF_HD void add(int wall, int i, Vec3<Real> x, Vec3<Real> way) const {
#if defined(__CUDA_ARCH__)
    const int part = i % kLoadParts;  // threads side by side write side by side
#else
    const int part = (i >> 8) % kLoadParts;  // a thread has some 256 particles in a row
#endif
    if (wall > 63 || summed >> wall & 1) {
      LoadSums& to = sums[wall * kLoadParts + part];
      const Vec3<Real> moment = moment_scale * cross(x, way);
      add_units(&to.way[0], way.x), add_units(&to.moment[0], moment.x);
      add_units(&to.way[1], way.y), add_units(&to.moment[1], moment.y);
      add_units(&to.way[2], way.z), add_units(&to.moment[2], moment.z);
    }
    for (int k = 0; k < patches; ++k)
      if (patch[k].wall == wall)
        add_units(&sums[patch[k].row * kLoadParts + part].way[0],
                  Real(-patch_way(patch[k], x, way)));
  }

 private:
  /// The wall gets the opposite.
  PBF_HD static void add_units(std::int64_t* to, Real x) {
    if (x != Real(0)) add_whole(to, units(-x));
  }
  /// Beyond 2^10 h, and what is no number, is for the guard to find.
  PBF_HD static std::int64_t units(Real x) {
    constexpr Real most(std::int64_t(1) << 46);
    const Real u = max2(min2(x * Real(kLoadUnits), most), -most);
    return std::int64_t(u + (u < Real(0) ? Real(-0.5) : Real(0.5)));
  }
};

/// The end of an update: adds what was booked to each wall's load and clears it.
struct LoadPass {
  LoadSums* sums;
  Load* load;                               ///< in/out
  double inv_dt, update_dt, moment_unit;    ///< 1/s of a substep, s, h
  const SolidVelocity* velocity = nullptr;  ///< of each obstacle; null: none moves
  int obstacles = 0;

  PBF_HD void operator()(int wall) const {
    LoadSums all;
    for (int part = 0; part < kLoadParts; ++part) {
      LoadSums& one = sums[wall * kLoadParts + part];
      for (int k = 0; k < 3; ++k) {
        all.way[k] += one.way[k];
        all.moment[k] += one.moment[k];
      }
      one = {};
    }
    Load& to = load[wall];
    const double unit = inv_dt / double(kLoadUnits);
    double squares = 0, impulse[3], moment[3];
    for (int k = 0; k < 3; ++k) {
      impulse[k] = unit * double(all.way[k]);
      moment[k] = unit * moment_unit * double(all.moment[k]);
    }
    if (velocity && wall >= 6 && wall < 6 + obstacles && velocity[wall - 6].moves) {
      const SolidVelocity& v = velocity[wall - 6];
      for (int k = 0; k < 3; ++k) to.work -= impulse[k] * v.linear[k] + moment[k] * v.angular[k];
      for (int k = 0; k < 3; ++k) {
        const int b = (k + 1) % 3, c = (k + 2) % 3;
        moment[k] -= v.middle[b] * impulse[c] - v.middle[c] * impulse[b];
      }
    }
    for (int k = 0; k < 3; ++k) {
      to.impulse[k] += impulse[k];
      to.moment[k] += moment[k];
      squares += impulse[k] * impulse[k];
    }
    to.peak = max2(to.peak, square_root(squares) / update_dt);
    to.time += update_dt;
  }
};

}  // namespace pbf::inline PBF_VARIANT
