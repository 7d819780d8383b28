// Images of particles beyond the faces of periodic axes (lib/exec/periodic/periodic_rows.h). Faces
// of such an axis are joined: a particle that leaves through one enters through the other, and
// those near one see images of those near the other. Images have rows of their own, so the passes
// over pairs know nothing of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/atomics.h"
#include "kernels/measure.h"
#include "kernels/params.h"
#include "kernels/row_state.h"

namespace pbf::PBF_VARIANT {

/// x in [0, period); 0: not periodic. What is not finite stays as it is.
template <class Real>
PBF_HD Real wrapped(Real x, Real period) {
  if (!(period > Real(0)) || (x >= Real(0) && x < period) || !is_finite(x)) return x;
  Real y = x < Real(0) ? x + period : x - period;
  if (!(y >= Real(0) && y <= period)) y = x - period * Real(std::floor(x / period));
  return y >= Real(0) && y < period ? y : Real(0);  // rounding may give the period itself
}
template <class Real>
PBF_HD Vec3<Real> wrapped(Vec3<Real> x, Vec3<Real> period) {
  return {wrapped(x.x, period.x), wrapped(x.y, period.y), wrapped(x.z, period.z)};
}

/// Shifts of an image by -1, 0 or 1 periods along x, y, z, as one number.
struct ImageShift {
  int code = 13;
  static PBF_HD ImageShift of(int x, int y, int z) { return {x + 1 + 3 * (y + 1) + 9 * (z + 1)}; }
  template <class Real>
  PBF_HD Vec3<Real> along(Vec3<Real> period) const {
    return {Real(code % 3 - 1) * period.x, Real(code / 3 % 3 - 1) * period.y,
            Real(code / 9 - 1) * period.z};
  }
};

/// An image: its row, the row of its particle, and where it is.
struct ImageRow {
  int row, source;
  ImageShift shift;
};

/// Puts particles into the domain.
template <class Real>
struct WrapRowsPass {
  Vec3<Real> period;
  Vec4<Real>* position;  ///< in/out
  PBF_HD void operator()(int i) const {
    position[i] = with_w(wrapped(xyz(position[i]), period), position[i].w);
  }
};

/// Lists the images that a particle needs, one for each set of faces that it is near; beyond `room`
/// it only counts. Every particle is inside.
template <class Real>
struct FindImagesPass {
  /// h, a little more than the range of pairs, so that rounding leaves none out.
  static constexpr double kNear = 1 + 1.0 / 64;
  Vec3<Real> period;
  const Vec4<Real>* position;
  ImageRow* list;
  int *count, room;

  PBF_HD void operator()(int i) const {
    const Vec4<Real> x = position[i];
    const int s[3] = {shift(x.x, period.x), shift(x.y, period.y), shift(x.z, period.z)};
    for (int set = 1; set < 8; ++set) {
      bool has = true;
      for (int a = 0; a < 3; ++a) has = has && (!(set >> a & 1) || s[a] != 0);
      if (!has) continue;
      const int k = take_place(count);
      if (k < room)
        list[k] = {-1, i,
                   ImageShift::of(set & 1 ? s[0] : 0, set & 2 ? s[1] : 0, set & 4 ? s[2] : 0)};
    }
  }

 private:
  /// The image of a particle near a face is beyond the other one.
  PBF_HD static int shift(Real x, Real period) {
    if (!(period > Real(0))) return 0;
    return x < Real(kNear) ? 1 : x >= period - Real(kNear) ? -1 : 0;
  }
};

/// Images that are used from now on have the rows of the last ones, then rows behind all others.
struct TakeImageRowsPass {
  ImageRow* list;
  const ImageRow* last;
  int lasts, rows;
  PBF_HD void operator()(int k) const { list[k].row = k < lasts ? last[k].row : rows + k - lasts; }
};
/// Images that are not used any more leave in the next sort.
struct LeaveImagesPass {
  const ImageRow* list;
  int* id;
  PBF_HD void operator()(int k) const { id[list[k].row] = -1; }
};

/// Copies the rows of particles to those of their images. Positions are shifted, ids marked; the
/// rest is copied in words of 4 bytes.
template <class Real>
struct CopyToImagesPass {
  static constexpr int most = 8;
  struct Part {
    std::uint32_t* rows = nullptr;
    int words = 0;  ///< of a row
  };
  const ImageRow* list;
  Vec3<Real> period;
  Vec4<Real>* position = nullptr;  ///< null: not copied
  int* id = nullptr;               ///< the same
  Part part[most] = {};
  int parts = 0;

  PBF_HD void operator()(int k) const {
    const ImageRow image = list[k];
    if (position) {
      const Vec4<Real> x = position[image.source];
      position[image.row] = with_w(xyz(x) + image.shift.along(period), x.w);
    }
    if (id) id[image.row] = id[image.source] | kImage;
    for (int p = 0; p < parts; ++p)
      for (int w = 0; w < part[p].words; ++w)
        std::memcpy(part[p].rows + std::int64_t(image.row) * part[p].words + w,
                    part[p].rows + std::int64_t(image.source) * part[p].words + w, 4);
  }
};

/// The row of each particle, by its id.
struct RowsOfIdsPass {
  const int* id;
  int* row_of;
  PBF_HD void operator()(int i) const {
    if (!is_image(id[i])) row_of[id[i]] = i;
  }
};
/// Lists the images after a sort.
template <class Real>
struct ListImagesPass {
  Vec3<Real> period;
  const Vec4<Real>* position;
  const int *id, *row_of;
  ImageRow* list;
  int* count;
  PBF_HD void operator()(int i) const {
    if (!is_image(id[i])) return;
    const int source = row_of[particle_of(id[i])];
    const Vec4<Real>&x = position[i], &y = position[source];
    list[take_place(count)] = {
        i, source,
        ImageShift::of(shift(x.x - y.x, period.x), shift(x.y - y.y, period.y),
                       shift(x.z - y.z, period.z))};
  }

 private:
  PBF_HD static int shift(Real d, Real period) {
    const Real half = Real(0.5) * period;
    return !(period > Real(0)) ? 0 : d > half ? 1 : d < -half ? -1 : 0;
  }
};

/// What a pass counts or sums over rows, without images.
template <class Pass>
struct WithoutImages : Pass {
  const int* id;  ///< null: there are none
  PBF_HD bool leaves_out(int i) const { return id && is_image(id[i]); }
  PBF_HD auto operator()(int i) const {
    using Result = decltype(Pass::operator()(i));
    return leaves_out(i) ? none(Result()) : Pass::operator()(i);
  }
  PBF_HD auto counts(int i) const {
    if (!leaves_out(i)) return Pass::counts(i);
    if constexpr (requires(const Pass& pass) { pass.of_steps(); })
      if (i == 0) return Pass::of_steps();
    return decltype(Pass::counts(i))();
  }
  PBF_HD auto terms(int i, const MeasureUnits& unit) const {
    return leaves_out(i) ? decltype(Pass::terms(i, unit))() : Pass::terms(i, unit);
  }

 private:
  static PBF_HD int none(int) { return -1; }  // of bins
  static PBF_HD std::uint64_t none(std::uint64_t) { return 0; }
};
/// A pass over listed rows, without images.
template <class Pass>
struct ListedWithoutImages : Pass {
  const int* id;  ///< null: there are none
  PBF_HD void operator()(int k) const {
    if (!id || !is_image(id[this->row(k)])) Pass::operator()(k);
  }
};

}  // namespace pbf::PBF_VARIANT
