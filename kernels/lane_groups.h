// Sums over neighbors for a group of adjacent particles, one per lane, and what the passes do with
// the sums: for a whole group, or one particle at a time.
#pragma once

#include "kernels/dissipation.h"
#include "kernels/lanes.h"

namespace pbf::PBF_VARIANT {

/// Rows i .. i + W - 1 of an array, as row() of rows.h; the array must contain all of them.
template <class Real, int W>
PBF_HD Vec4<Lanes<Real, W>> row(OwnRows<Vec4<Real>> a, Adjacent<W> i) {
  return transposed<Real, W>(a.rows(), i);
}
template <class Real, int W>
requires std::is_floating_point_v<std::remove_const_t<Real>>
    PBF_HD Lanes<std::remove_const_t<Real>, W> row(OwnRows<Real> a, Adjacent<W> i) {
  return adjacent<std::remove_const_t<Real>, W>(a.rows(), i);
}
template <class Real, int W>
PBF_HD void set_row(OwnRows<Real> a, Adjacent<W> i, const Lanes<Real, W>& value) {
  value.to(a.rows() + i.first);
}
template <class Real, int W>
PBF_HD void set_row(OwnRows<Vec4<Real>> a, Adjacent<W> i, const Vec4<Lanes<Real, W>>& value) {
  Vec4<Real>* to = a.rows() + i.first;
  if constexpr (W < 4) {
    for (int l = 0; l < W; ++l) to[l] = {value.x.v[l], value.y.v[l], value.z.v[l], value.w.v[l]};
  } else {
    // As in transposed(), backward.
    using Vector = typename Lanes<Real, W>::Vector;
    const Vector xy0 = shuffled<Real, W>(value.x.v, value.y.v, block::low);
    const Vector xy1 = shuffled<Real, W>(value.x.v, value.y.v, block::high);
    const Vector zw0 = shuffled<Real, W>(value.z.v, value.w.v, block::low);
    const Vector zw1 = shuffled<Real, W>(value.z.v, value.w.v, block::high);
    const Vector rows[4] = {
        shuffled<Real, W>(xy0, zw0, block::first), shuffled<Real, W>(xy0, zw0, block::second),
        shuffled<Real, W>(xy1, zw1, block::first), shuffled<Real, W>(xy1, zw1, block::second)};
    const auto part = [&](const Vector& v, auto k) __attribute__((always_inline)) {
      constexpr int b = 4 * decltype(k)::value;
      return Lanes<Real, 4>(__builtin_shufflevector(v, v, b, b + 1, b + 2, b + 3));
    };
    [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
      ((part(rows[0], std::integral_constant<int, k>{}).to(&to[4 * k].x),
        part(rows[1], std::integral_constant<int, k>{}).to(&to[4 * k + 1].x),
        part(rows[2], std::integral_constant<int, k>{}).to(&to[4 * k + 2].x),
        part(rows[3], std::integral_constant<int, k>{}).to(&to[4 * k + 3].x)),
       ...);
    }
    (std::make_integer_sequence<int, W / 4>{});
  }
}
template <class Real, int W, class F>
PBF_HD void for_rows_where(const LaneMask<Real, W>& c, Adjacent<W> i, F&& f) {
  if (!holds_somewhere(c)) return;
  for (int l = 0; l < W; ++l)
    if (c.v[l] > c.half) f(i[l]);
}

template <class Real, int W>
PBF_HD Lanes<double, W> energy_taken(const Vec3<Lanes<Real, W>>& v,
                                     const Vec3<Lanes<Real, W>>& now) {
  const Lanes<Real, W> twice = dot(v - now, v + now);
  Lanes<double, W> r;
  for (int l = 0; l < W; ++l) r.v[l] = 0.5 * double(twice.v[l]);
  return r;
}
/// W whole numbers, for the cells of the grid (kernels/cell_index.h).
template <int W>
struct LaneInts {
  typedef int Vector __attribute__((vector_size(W * sizeof(int))));
  typedef int Anywhere
      __attribute__((vector_size(W * sizeof(int)), aligned(sizeof(int)), may_alias));
  Vector v;

  LaneInts() = default;
  PBF_HD explicit LaneInts(int x) : v(Vector{} + x) {}
  PBF_HD LaneInts(const Vector& x) : v(x) {}
  friend PBF_HD LaneInts operator+(const LaneInts& a, const LaneInts& b) { return a.v + b.v; }
  friend PBF_HD LaneInts operator*(const LaneInts& a, int b) { return a.v * b; }
  friend PBF_HD LaneInts operator*(int a, const LaneInts& b) { return a * b.v; }
  friend PBF_HD LaneInts operator&(const LaneInts& a, int b) { return a.v & b; }
};
template <int W>
PBF_HD void set_row(OwnRows<int> a, Adjacent<W> i, const LaneInts<W>& value) {
  *reinterpret_cast<typename LaneInts<W>::Anywhere*>(a.rows() + i.first) = value.v;
}
template <class Real, int W>
PBF_HD LaneInts<W> cell_coordinate(const Lanes<Real, W>& x, Real inv_cell, int cells) {
  const Lanes<Real, W> s = x * inv_cell;
  if (holds_everywhere(s >= Real(0) && s < Real(cells)))
    return __builtin_convertvector(s.v, typename LaneInts<W>::Vector);
  typename LaneInts<W>::Vector r{};
  for (int l = 0; l < W; ++l) r[l] = cell_coordinate(Real(x.v[l]), inv_cell, cells);
  return r;
}

/// Finishes the particles one at a time. part: component c of lane l is at [c W + l].
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
/// For groups that are seldom: where a particle may be near a solid, or is an exception for the
/// formulas of several.
template <int W, class Pass, class Real>
PBF_HD_APART void finish_each(const Pass& pass, int i, int end, const Real* part) {
  finish_lanes<W>(pass, i, end, part);
}

/// Finishes those of a group that are below `end`.
template <int W, class Real, class Pass, class Own, class Sum>
PBF_HD void finish_group(const Pass& pass, int i, int end, const Own& own, const Sum& sum) {
  Real part[sizeof(sum) / sizeof(Real)];
  if constexpr (requires {
                  pass.together(sum);
                  pass.finish(Adjacent<W>{i}, own, sum);
                }) {
    if (i + W <= end && pass.together(sum)) return pass.finish(Adjacent<W>{i}, own, sum);
    memcpy(part, &sum, sizeof sum);
    finish_each<W>(pass, i, end, part);
  } else {
    memcpy(part, &sum, sizeof sum);
    finish_lanes<W>(pass, i, end, part);
  }
}

/// How far ahead of the pair loop entries of lists are fetched, one or two groups: 2 KiB.
inline constexpr int kEntriesAhead = 512;

/// The neighbor sums of those of the particles i .. i + W - 1 that are below `end`; W divides i.
/// The lists of such a group are padded to equal length with the far particle.
template <class Real, int W, class Pass>
PBF_HD void sum_over_neighbors_by_lanes(const Pass& pass, int i, int end) {
  using V = Lanes<Real, W>;
  const auto own = pass.own(Adjacent<W>{i});
  typename Pass::template SumOf<V> sum{};
  const int* entry = pass.lists.group(i);
  for (int left = pass.lists.rounds(i); left > 0; --left, entry += W) {
    // Processors do not recognize the stream of entries: they are read one by one.
    __builtin_prefetch(entry + kEntriesAhead);
    pass.add(sum, own, pass.other(Scattered<W>{entry}));
  }
  if constexpr (requires { pass.plain(); }) {  // boundary/near_split.h
    if (!pass.all_far(Adjacent<W>{i}, own, sum)) {
      Real part[sizeof(sum) / sizeof(Real)];
      memcpy(part, &sum, sizeof sum);
      return finish_each<W>(pass, i, end, part);
    }
    finish_group<W, Real>(pass.plain(), i, end, own, sum);
  } else {
    finish_group<W, Real>(pass, i, end, own, sum);
  }
}

}  // namespace pbf::PBF_VARIANT
