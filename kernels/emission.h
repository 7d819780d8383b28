// Emitters and sinks in a step. kernels/README.md, "Emitters and sinks".
#pragma once

#include <cstdint>

#include "kernels/boundary/near_rows.h"
#include "kernels/dissipation.h"
#include "kernels/params.h"
#include "kernels/rows.h"

namespace pbf {

/// Most layers of an emitter that are in its pipe at a time.
inline constexpr int kPipeLayers = 16;

/// What an emitter has brought, or a sink taken, since the start; energies and momenta per mass of
/// a particle, as in kernels/dissipation.h.
struct EmissionSum {
  std::int64_t particles = 0;  ///< that a sink has taken; of an emitter those without a row
  std::int64_t first = -1;     ///< of an emitter: the first id without a row
  DissipationSum energy{};     ///< in units of (h/time.step)^2
  DissipationSum momentum[3];  ///< in units of h/time.step

  /// Calls f for every number, in the order of files.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    f(s.particles), f(s.first);
    DissipationSum::each(s.energy, f);
    for (auto& m : s.momentum) DissipationSum::each(m, f);
  }
};

/// The row of the table of steps.
struct EmissionRow {
  int now = 0, next = 0;
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// An opening and the bore behind it. Lengths in h, in the internal frame.
template <class Real>
struct Nozzle {
  Vec3<Real> center, normal, side[2];  ///< unit vectors; sides lie in the plane of the opening
  Real half[2] = {0, 0};               ///< half the edges; of a disc the radius
  Real depth = 0, spacing = 0;         ///< of the bore; of its layers
  int disc = 0, columns = 0, first_column = 0;
};

/// An emitter in a step. Layers are numbered from the first that is in the pipe at the start.
template <class Real>
struct NozzleStep {
  Real front = 0;            ///< h, of the first layer at the end of the step: beyond the opening
  Real speed = 0;            ///< h/s, of all
  int released = 0;          ///< layers that leave the pipe
  int held = 0;              ///< all, with those
  int born = 0;              ///< the last ones, which come before the sort of this step
  int id[kPipeLayers] = {};  ///< of the first particle of each layer
};

template <class Real>
struct SinkBox {
  Vec3<Real> min, max;  ///< h
};

/// Books energies and momenta that come into the fluid, per mass of a particle.
struct EmissionBook {
  EmissionSum* sums = nullptr;
  double inv_speed = 0;  ///< s/h, of the unit of momenta
  template <class Real>
  PBF_HD static double energy(Vec3<Real> x, Vec3<Real> v, Vec3<Real> gravity) {
    return 0.5 * double(dot(v, v)) - double(dot(gravity, x));
  }
  PBF_HD void add_energy(int k, double gained) const {
    DissipationBook{&sums[k].energy, 0, inv_speed * inv_speed}.add(0, gained);
  }
  PBF_HD void add_momentum(int k, int axis, double gained) const {
    DissipationBook{&sums[k].momentum[axis], 0, inv_speed}.add(0, gained);
  }
};

/// All emitters in the present step.
template <class Real>
struct Pipes {
  const Nozzle<Real>* nozzle = nullptr;
  const NozzleStep<Real>* steps = nullptr;  ///< the table
  const EmissionRow* row = nullptr;
  const Vec4<Real>* column = nullptr;  ///< where columns go through the opening
  int nozzles = 0;
  Vec3<Real> gravity;
  EmissionBook book;
  NearRows<Real> near{};  ///< empty without solids

  PBF_HD const NozzleStep<Real>& step(int e) const { return steps[row->now * nozzles + e]; }

  /// Which layer of emitter e the particle is in, at least `from`; -1: none.
  PBF_HD int layer_of(int e, int id, int from) const {
    const NozzleStep<Real>& s = step(e);
    for (int m = from; m < s.held; ++m)
      if (unsigned(id - s.id[m]) < unsigned(nozzle[e].columns)) return m;
    return -1;
  }
  PBF_HD Vec3<Real> place(int e, int layer, int id, Real more = Real(0)) const {
    const NozzleStep<Real>& s = step(e);
    const Real along = s.front - Real(layer) * nozzle[e].spacing + more;
    return mul_add(along, nozzle[e].normal,
                   xyz(column[nozzle[e].first_column + (id - s.id[layer])]));
  }

  /// Where a free particle at x may be: before the face of what is held, half a spacing before the
  /// first layer, which pushes like a piston. Its casing is a solid, which keeps it out elsewhere.
  PBF_HD Vec3<Real> kept_out(int e, Vec3<Real> x) const {
    const Nozzle<Real>& n = nozzle[e];
    const NozzleStep<Real>& s = step(e);
    const Vec3<Real> off = x - n.center;
    const Real along = dot(off, n.normal);
    const Real face = s.front + (Real(0.5) - Real(s.released)) * n.spacing;
    if (!(along < face && along > -n.depth)) return x;
    const Real a = dot(off, n.side[0]), b = dot(off, n.side[1]);
    const bool in = n.disc ? a * a + b * b < n.half[0] * n.half[0]
                           : a < n.half[0] && -a < n.half[0] && b < n.half[1] && -b < n.half[1];
    return in ? x + (face - along) * n.normal : x;
  }

  /// Whether x is in the pipe of emitter e or within `room` of it.
  PBF_HD bool is_near(int e, Vec3<Real> x, Real room) const {
    const Nozzle<Real>& n = nozzle[e];
    const Vec3<Real> off = x - n.center;
    const Real along = dot(off, n.normal), a = dot(off, n.side[0]), b = dot(off, n.side[1]);
    return along < n.spacing + room && along > -n.depth - room && a < n.half[0] + room &&
           -a < n.half[0] + room && b < n.half[1] + room && -b < n.half[1] + room;
  }

  /// Puts particle `id` at x with velocity v where it belongs: in a pipe to the place and speed of
  /// its layer, elsewhere out of the pipes. predicted: after the prediction, where layers that are
  /// released in this step still count as held. True if it was moved. Books the work: impulse times
  /// speed; in the prediction, where speeds change, the change of the energy.
  PBF_HD bool hold(int id, bool predicted, const Params<Real>& p, Vec3<Real>& x, Vec3<Real>& v,
                   bool& held) const {
    const Vec3<Real> was = v;
    held = false;
    for (int e = 0; e < nozzles; ++e) {
      const int layer = layer_of(e, id, predicted ? 0 : step(e).released);
      if (layer < 0) continue;
      held = true;
      x = place(e, layer, id);
      v = step(e).speed * nozzle[e].normal;
      const Vec3<Real> speed = predicted ? Real(0.5) * (v + was) : v;
      book.add_energy(e, repeated(predicted, p) * double(dot(speed, v - was)));
      return true;
    }
    for (int e = 0; e < nozzles; ++e) {
      const Vec3<Real> to = kept_out(e, x);
      if (to.x == x.x && to.y == x.y && to.z == x.z) continue;
      v = v + p.inv_dt * (to - x);
      x = to;
      book.add_energy(
          e, repeated(predicted, p) * double(dot(step(e).speed * nozzle[e].normal, v - was)));
      return true;
    }
    return false;
  }

 private:
  /// What a correction takes from the fluid, later predictions take again in part: they carry on
  /// with a share of its push. Those of what is held do not.
  PBF_HD static double repeated(bool predicted, const Params<Real>& p) {
    return predicted ? 1 : 1 / (1 - double(p.carry));
  }
};

}  // namespace pbf::PBF_VARIANT
