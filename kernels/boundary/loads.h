// Loads on walls: every displacement that a wall gives to a particle is booked on that wall. The
// sums are integers, so order and threads do not matter.
#pragma once

#include <cstdint>

#include "kernels/atomics.h"
#include "kernels/boundary/moving.h"
#include "kernels/boundary/patch.h"
#include "kernels/vec3.h"

namespace pbf {

/// Number of partial sums per wall, which different threads write.
inline constexpr int kLoadParts = 64;

/// Row of a solid among the sums and loads: behind those of the six walls.
PBF_HD constexpr int load_row_of_solid(int solid) { return 6 + solid; }

/// Units of booked displacements per h.
inline constexpr std::int64_t kLoadUnits = std::int64_t(1) << 36;

/// Booked on one wall within an update: displacements in units of h/kLoadUnits, with the sign of
/// the force on the wall, and moments about the domain's lower corner in these units times
/// 1/moment_scale. Of a pressure gauge only way[0] is used, positive into the wall.
struct LoadSums {
  std::int64_t way[3] = {0, 0, 0}, moment[3] = {0, 0, 0};
};

/// Load of one wall since the last reading, per mass of a particle, in the internal frame.
struct Load {
  double impulse[3] = {0, 0, 0};  ///< h/s
  /// h^2/s, about the domain's lower corner; for a moving obstacle about its center.
  double moment[3] = {0, 0, 0};
  double peak = 0;              ///< h/s^2, largest mean force of one update
  double time = 0;              ///< s
  double work = 0;              ///< h^2/s^2, done by a moving obstacle; lost by a free body
  double total[3] = {0, 0, 0};  ///< h/s, the impulse since the start

  /// After a reading: the means begin again.
  PBF_HD Load begun_again() const {
    Load next;
    for (int k = 0; k < 3; ++k) next.total[k] = total[k];
    return next;
  }
  /// Calls f for every number, in the order of files.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    for (auto& x : s.impulse) f(x);
    for (auto& x : s.moment) f(x);
    f(s.peak), f(s.time), f(s.work);
    for (auto& x : s.total) f(x);
  }
};

/// What a wall gave to particles in the iterations of the last substep, in units as in LoadSums.
/// Only with time steps of second order, whose predictions give particles a share of it once more.
struct WallPush {
  double way[3] = {0, 0, 0}, moment[3] = {0, 0, 0};
  /// The sums before the present substep; 0 between two updates.
  double way_before[3] = {0, 0, 0}, moment_before[3] = {0, 0, 0};

  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    for (auto& x : s.way) f(x);
    for (auto& x : s.moment) f(x);
  }
};

/// A tally (kernels/gauge_probe.h) that is made with the loads of walls.
struct PatchTally {
  using Site = Patch;
  using Sums = Load;
  static constexpr const char* sites = "patches";
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// Where loads are booked.
template <class Real>
struct LoadBook {
  LoadSums* sums = nullptr;      ///< kLoadParts for each wall; null: there are none
  LoadSums* clamps = nullptr;    ///< the same for predictions; null: these are among `sums`
  Real moment_scale = 1;         ///< 2^-e, 2^e above the longest edge of the box, h
  const Patch* patch = nullptr;  ///< pressure gauges
  int patches = 0;
  /// Bit k: wall k has sums of its own. Walls beyond the last bit always have them.
  std::uint64_t summed = ~std::uint64_t(0);

  /// Whether loads of the domain's walls are needed, for their own sums or for gauges.
  PBF_HD bool of_walls() const { return (summed & 63) != 0 || patches > 0; }

  /// Books that wall `wall` has moved particle i, which is at x, by `way` (h). start: at the start
  /// of a step, in the prediction.
  PBF_HD void add(int wall, int i, Vec3<Real> x, Vec3<Real> way, bool start = false) const {
    LoadSums* const rows = start && clamps ? clamps : sums;
    const int part = part_of(i);
    if (wall > 63 || summed >> wall & 1) {
      LoadSums& to = rows[wall * kLoadParts + part];
      const Vec3<Real> moment = moment_scale * cross(x, way);
      add_units(&to.way[0], way.x), add_units(&to.moment[0], moment.x);
      add_units(&to.way[1], way.y), add_units(&to.moment[1], moment.y);
      add_units(&to.way[2], way.z), add_units(&to.moment[2], moment.z);
    }
    for (int k = 0; k < patches; ++k)
      if (patch[k].wall == wall)
        add_units(&rows[patch[k].row * kLoadParts + part].way[0],
                  Real(-patch_way(patch[k], x, way)));
  }

  /// Which of the partial sums of a wall particle i adds to.
  PBF_HD static int part_of(int i) {
#if defined(__CUDA_ARCH__)
    return i % kLoadParts;  // adjacent threads write to different parts
#else
    return (i >> 8) % kLoadParts;  // a thread has about 256 adjacent particles
#endif
  }

 private:
  /// The wall gets the opposite.
  PBF_HD static void add_units(std::int64_t* to, Real x) {
    if (x != Real(0)) add_whole(to, units(-x));
  }
  /// Limited to 2^10 h. The guard detects larger and non-finite displacements.
  PBF_HD static std::int64_t units(Real x) {
    constexpr Real most(std::int64_t(1) << 46);
    const Real u = max2(min2(x * Real(kLoadUnits), most), -most);
    return std::int64_t(u + (u < Real(0) ? Real(-0.5) : Real(0.5)));
  }
};

/// Adds the sums of a wall over all parts to `all`.
PBF_HD LoadSums all_parts(const LoadSums* sums, int wall, LoadSums all = {}) {
  for (int part = 0; part < kLoadParts; ++part) {
    const LoadSums& one = sums[wall * kLoadParts + part];
    for (int k = 0; k < 3; ++k) {
      all.way[k] += one.way[k];
      all.moment[k] += one.moment[k];
    }
  }
  return all;
}

/// At the start of a substep: books the share of the last push of each wall that the predictions
/// of this substep take over.
struct CarryLoadsPass {
  LoadSums* sums;
  WallPush* push;  ///< in/out
  double carry;

  PBF_HD void operator()(int wall) const {
    const LoadSums all = all_parts(sums, wall);
    LoadSums& to = sums[wall * kLoadParts];
    WallPush& p = push[wall];
    for (int k = 0; k < 3; ++k) {
      const double way = p.way[k] + (double(all.way[k]) - p.way_before[k]);
      const double moment = p.moment[k] + (double(all.moment[k]) - p.moment_before[k]);
      to.way[k] += whole(carry * way);
      to.moment[k] += whole(carry * moment);
      p.way[k] = p.moment[k] = 0;
      p.way_before[k] = double(all.way[k]);
      p.moment_before[k] = double(all.moment[k]);
    }
  }

 private:
  PBF_HD static std::int64_t whole(double x) { return std::int64_t(x + (x < 0 ? -0.5 : 0.5)); }
};

/// At the end of an update: adds the booked sums to the load of each wall and clears them.
struct LoadPass {
  LoadSums* sums;
  Load* load;                               ///< in/out
  double inv_dt, update_dt, moment_unit;    ///< 1/s of a substep, s, h
  const SolidVelocity* velocity = nullptr;  ///< of each obstacle; null: none moves
  int obstacles = 0;
  WallPush* push = nullptr;    ///< out; null in first order
  LoadSums* clamps = nullptr;  ///< LoadBook::clamps

  PBF_HD void operator()(int wall) const {
    LoadSums all = all_parts(sums, wall);
    clear(sums, wall);
    if (push) {
      WallPush& p = push[wall];
      for (int k = 0; k < 3; ++k) {
        p.way[k] = double(all.way[k]) - p.way_before[k];
        p.moment[k] = double(all.moment[k]) - p.moment_before[k];
        p.way_before[k] = p.moment_before[k] = 0;
      }
      all = all_parts(clamps, wall, all);
      clear(clamps, wall);
    }
    Load& to = load[wall];
    const double unit = inv_dt / double(kLoadUnits);
    double squares = 0, impulse[3], moment[3];
    for (int k = 0; k < 3; ++k) {
      impulse[k] = unit * double(all.way[k]);
      moment[k] = unit * moment_unit * double(all.moment[k]);
    }
    const int solid = wall - load_row_of_solid(0);
    if (velocity && solid >= 0 && solid < obstacles && velocity[solid].moves) {
      const SolidVelocity& v = velocity[solid];
      for (int k = 0; k < 3 && !v.free; ++k)
        to.work -= impulse[k] * v.linear[k] + moment[k] * v.angular[k];
      for (int k = 0; k < 3; ++k) {
        const int b = (k + 1) % 3, c = (k + 2) % 3;
        moment[k] -= v.middle[b] * impulse[c] - v.middle[c] * impulse[b];
      }
    }
    for (int k = 0; k < 3; ++k) {
      to.impulse[k] += impulse[k];
      to.total[k] += impulse[k];
      to.moment[k] += moment[k];
      squares += impulse[k] * impulse[k];
    }
    to.peak = max2(to.peak, square_root(squares) / update_dt);
    to.time += update_dt;
  }

 private:
  PBF_HD static void clear(LoadSums* sums, int wall) {
    for (int part = 0; part < kLoadParts; ++part) sums[wall * kLoadParts + part] = {};
  }
};

}  // namespace pbf::PBF_VARIANT
