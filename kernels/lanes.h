// Several particles side by side in one vector register. The pair formulas of the passes, written
// for one Real, also work for Lanes. Every lane does the operations of a single particle in the
// same order, so the bits are the same. With the vector types of GCC and clang, the compiler splits
// vectors that are wider than the registers of the processor.
#pragma once

#include <string.h>

#include <utility>

#include "kernels/pair_sum.h"

namespace pbf::PBF_VARIANT {

/// W numbers; a plain number is converted to W equal ones.
template <class Real, int W>
struct Lanes {
  typedef Real Vector __attribute__((vector_size(W * sizeof(Real))));
  Vector v;

  Lanes() = default;  ///< value-initialized to zero, as Real is
  /// Written as a sum, which compilers turn into one addition and a broadcast. A plain copy becomes
  /// W insertions if this is inlined into a function for wider registers. The sum turns -0 into 0,
  /// which changes no sum over neighbors.
  PBF_HD Lanes(Real x) : v(Vector{} + x) {}
  PBF_HD Lanes(const Vector& x) : v(x) {}
  /// from[0] .. from[W - 1], at any address.
  static PBF_HD Lanes at(const Real* from) {
    return Vector(*reinterpret_cast<const Anywhere*>(from));
  }
  PBF_HD void to(Real* a) const { *reinterpret_cast<Anywhere*>(a) = v; }

  friend PBF_HD Lanes operator+(const Lanes& a, const Lanes& b) { return a.v + b.v; }
  friend PBF_HD Lanes operator-(const Lanes& a, const Lanes& b) { return a.v - b.v; }
  friend PBF_HD Lanes operator*(const Lanes& a, const Lanes& b) { return a.v * b.v; }
  friend PBF_HD Lanes operator/(const Lanes& a, const Lanes& b) { return a.v / b.v; }
  PBF_HD Lanes& operator+=(const Lanes& a) { return *this = *this + a; }
  PBF_HD Lanes& operator-=(const Lanes& a) { return *this = *this - a; }

 private:
  typedef Real Anywhere
      __attribute__((vector_size(W * sizeof(Real)), aligned(sizeof(Real)), may_alias));
};

template <class Real, int W>
PBF_HD Lanes<Real, W> max2(const Lanes<Real, W>& a, const Lanes<Real, W>& b) {
  return typename Lanes<Real, W>::Vector(a.v > b.v ? a.v : b.v);
}
/// The compiler turns the loop into one instruction.
template <class Real, int W>
PBF_HD Lanes<Real, W> square_root(const Lanes<Real, W>& a) {
  typename Lanes<Real, W>::Vector r;
  for (int l = 0; l < W; ++l) r[l] = square_root(Real(a.v[l]));
  return r;
}

/// The particles first .. first + W - 1; the array must contain all of them.
template <int W>
struct Adjacent {
  int first;
  PBF_HD int operator[](int lane) const { return first + lane; }
};
/// W arbitrary particles.
template <int W>
struct Scattered {
  const int* index;
  PBF_HD int operator[](int lane) const { return index[lane]; }
};

/// Transposes the rows (x, y, z, w) of W particles into one vector per component: one load per
/// particle and shuffles of whole registers, which is cheaper than four gathers.
template <class Real, int W, class Index>
PBF_HD Vec4<Lanes<Real, W>> transposed(const Vec4<Real>* a, Index i) {
  using Vector = typename Lanes<Real, W>::Vector;
  Vec4<Lanes<Real, W>> r;
  if constexpr (W < 4) {
    for (int l = 0; l < W; ++l) {
      const Vec4<Real>& from = a[i[l]];
      r.x.v[l] = from.x, r.y.v[l] = from.y, r.z.v[l] = from.z, r.w.v[l] = from.w;
    }
  } else {
    // row[k]: particles k, k + 4, k + 8, ... one after the other.
    const auto one = [&](int l) __attribute__((always_inline)) {
      return Lanes<Real, 4>::at(&a[i[l]].x).v;
    };
    Vector row[4];
    for (int k = 0; k < 4; ++k) {
      if constexpr (W == 4) {
        row[k] = one(k);
      } else if constexpr (W == 8) {
        row[k] = __builtin_shufflevector(one(k), one(k + 4), 0, 1, 2, 3, 4, 5, 6, 7);
      } else {
        static_assert(W == 16);
        row[k] = __builtin_shufflevector(
            __builtin_shufflevector(one(k), one(k + 4), 0, 1, 2, 3, 4, 5, 6, 7),
            __builtin_shufflevector(one(k + 8), one(k + 12), 0, 1, 2, 3, 4, 5, 6, 7), 0, 1, 2, 3, 4,
            5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      }
    }
    // Every block of 4 x 4 separately: pairs of rows into xy and zw, then pairs of those.
    const auto shuffle =
        [](const Vector& b, const Vector& c, auto pattern) __attribute__((always_inline)) {
      return [&]<int... l>(std::integer_sequence<int, l...>) __attribute__((always_inline)) {
        return Vector(__builtin_shufflevector(
            b, c, (pattern(l % 4) % 4 + l / 4 * 4 + (pattern(l % 4) >= 4 ? W : 0))...));
      }
      (std::make_integer_sequence<int, W>{});
    };
    constexpr auto low = [](int l) { return l / 2 + 4 * (l % 2); };       // 0 4 1 5
    constexpr auto high = [](int l) { return l / 2 + 2 + 4 * (l % 2); };  // 2 6 3 7
    constexpr auto first = [](int l) { return l % 2 + 4 * (l / 2); };     // 0 1 4 5
    constexpr auto second = [](int l) { return l % 2 + 2 + 4 * (l / 2); };
    const Vector xy0 = shuffle(row[0], row[1], low), xy1 = shuffle(row[2], row[3], low);
    const Vector zw0 = shuffle(row[0], row[1], high), zw1 = shuffle(row[2], row[3], high);
    r.x = shuffle(xy0, xy1, first);
    r.y = shuffle(xy0, xy1, second);
    r.z = shuffle(zw0, zw1, first);
    r.w = shuffle(zw0, zw1, second);
  }
  return r;
}
template <class Real, int W>
PBF_HD Vec4<Lanes<Real, W>> load(OwnRows<const Vec4<Real>> a, Adjacent<W> i) {
  return transposed<Real, W>(a.rows(), i);
}
template <class Real, int W>
PBF_HD Vec4<Lanes<Real, W>> load(GatheredRows<Vec4<Real>> a, Adjacent<W> i) {
  return transposed<Real, W>(a.rows(), i);
}
template <class Real, int W>
PBF_HD Vec4<Lanes<Real, W>> load(GatheredRows<Vec4<Real>> a, Scattered<W> i) {
  return transposed<Real, W>(a.rows(), i);
}
/// One number for each of W particles.
template <class Real, int W, template <int> class Index>
requires std::is_floating_point_v<Real> PBF_HD Lanes<Real, W> load(OwnRows<const Real> a,
                                                                   Index<W> i) {
  Lanes<Real, W> r;
  for (int l = 0; l < W; ++l) r.v[l] = a.rows()[i[l]];
  return r;
}

/// The numbers of W adjacent rows; the array must contain all of them.
template <class Real, int W>
PBF_HD Lanes<Real, W> adjacent(const Real* a, Adjacent<W> i) {
  return Lanes<Real, W>::at(a + i.first);
}
/// Whether a <= b in every lane; false if one of them is NaN.
template <class Real, int W>
PBF_HD bool all_at_most(const Lanes<Real, W>& a, const Lanes<Real, W>& b) {
  const auto within = a.v <= b.v;
  auto all = within[0];
  for (int l = 1; l < W; ++l) all &= within[l];
  return all != 0;
}

/// Finishes the particles one at a time, because this part is short and has branches. part:
/// component c of lane l is at [c W + l].
template <int W, class Pass, class Real>
PBF_HD void finish_lanes(const Pass& pass, int i, int end, const Real* part) {
  constexpr int parts = sizeof(typename Pass::Sum) / sizeof(Real);
  for (int l = 0; l < W && i + l < end; ++l) {
    Real mine[parts];
    for (int c = 0; c < parts; ++c) mine[c] = part[c * W + l];
    typename Pass::Sum one;
    memcpy(&one, mine, sizeof one);
    pass.finish(i + l, pass.own(i + l), one);
  }
}
/// For groups in which particles may be near solids.
template <int W, class Pass, class Real>
PBF_HD_APART void finish_each(const Pass& pass, int i, int end, const Real* part) {
  finish_lanes<W>(pass, i, end, part);
}

/// The neighbor sums of those of the particles i .. i + W - 1 that are below `end`; W divides i.
/// The lists of such a group are padded to equal length with the far particle.
template <class Real, int W, class Pass>
PBF_HD void sum_over_neighbors_by_lanes(const Pass& pass, int i, int end) {
  using V = Lanes<Real, W>;
  const auto own = pass.own(Adjacent<W>{i});
  typename Pass::template SumOf<V> sum{};
  const int* entry = pass.lists.group(i);
  for (int left = pass.lists.rounds(i); left > 0; --left, entry += W)
    pass.add(sum, own, pass.other(Scattered<W>{entry}));
  constexpr int parts = sizeof(sum) / sizeof(V);
  Real part[parts * W];
  memcpy(part, &sum, sizeof sum);
  if constexpr (requires { pass.plain(); }) {  // boundary/near_split.h
    if (!pass.all_far(Adjacent<W>{i}, own, sum)) return finish_each<W>(pass, i, end, part);
    finish_lanes<W>(pass.plain(), i, end, part);
  } else {
    finish_lanes<W>(pass, i, end, part);
  }
}

}  // namespace pbf::PBF_VARIANT
