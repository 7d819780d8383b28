// Several particles side by side in one vector register. The pair formulas of the passes, written
// for one Real, also work for Lanes. Every lane does the operations of a single particle in the
// same order, so the bits are the same. With the vector types of GCC and clang, the compiler splits
// vectors that are wider than the registers of the processor.
#pragma once

#include <string.h>

#include <utility>

#include "kernels/pair_sum.h"

namespace pbf::PBF_VARIANT {

/// A condition for each of W particles: 1 where it holds, elsewhere a small number. Numbers,
/// because GCC splits vectors of integers that are the result of a comparison into single ones,
/// unless they only choose between two vectors. Not 0, because it then makes the product one of
/// integers.
template <class Real, int W>
struct LaneMask {
  typedef Real Vector __attribute__((vector_size(W * sizeof(Real))));
  static constexpr Real no = Real(0x1p-10), half = Real(0.5);
  Vector v;

  friend PBF_HD LaneMask operator!(const LaneMask& a) {
    return {a.v > half ? Vector{} + no : Vector{} + Real(1)};
  }
  friend PBF_HD LaneMask operator&&(const LaneMask& a, const LaneMask& b) { return {a.v * b.v}; }
  friend PBF_HD LaneMask operator||(bool a, const LaneMask& b) {
    return a ? LaneMask{Vector{} + Real(1)} : b;
  }
};
/// Adds by halves, so that no lane is read alone.
template <class Real, int W>
PBF_HD bool holds_somewhere(const LaneMask<Real, W>& a) {
  if constexpr (W == 2) {
    return a.v[0] + a.v[1] > a.half;
  } else {
    return [&]<int... l>(std::integer_sequence<int, l...>) __attribute__((always_inline)) {
      return holds_somewhere(
          LaneMask<Real, W / 2>{__builtin_shufflevector(a.v, a.v, l...) +
                                __builtin_shufflevector(a.v, a.v, W / 2 + l...)});
    }
    (std::make_integer_sequence<int, W / 2>{});
  }
}
template <class Real, int W>
PBF_HD bool holds_everywhere(const LaneMask<Real, W>& a) {
  return !holds_somewhere(!a);
}

/// W numbers; a plain number is converted to W equal ones.
template <class Real, int W>
struct Lanes {
  static constexpr int width = W;
  typedef Real Vector __attribute__((vector_size(W * sizeof(Real))));
  using Mask = LaneMask<Real, W>;
  Vector v;

  Lanes() = default;  ///< value-initialized to zero, as Real is
  /// Written as a sum, which compilers turn into one addition and a broadcast. A plain copy becomes
  /// W insertions if this is inlined into a function for wider registers. The sum turns -0 into 0,
  /// which changes no sum over neighbors; after the sums, only gravity may be -0, in the position
  /// of which a bin is taken.
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
  friend PBF_HD Lanes operator-(const Lanes& a) { return -a.v; }
  friend PBF_HD Mask operator<(const Lanes& a, const Lanes& b) {
    return {a.v < b.v ? Vector{} + Real(1) : Vector{} + Mask::no};
  }
  friend PBF_HD Mask operator>(const Lanes& a, const Lanes& b) {
    return {a.v > b.v ? Vector{} + Real(1) : Vector{} + Mask::no};
  }
  friend PBF_HD Mask operator<=(const Lanes& a, const Lanes& b) {
    return {a.v <= b.v ? Vector{} + Real(1) : Vector{} + Mask::no};
  }
  friend PBF_HD Mask operator>=(const Lanes& a, const Lanes& b) {
    return {a.v >= b.v ? Vector{} + Real(1) : Vector{} + Mask::no};
  }
  PBF_HD Lanes& operator+=(const Lanes& a) { return *this = *this + a; }
  PBF_HD Lanes& operator-=(const Lanes& a) { return *this = *this - a; }

 private:
  typedef Real Anywhere
      __attribute__((vector_size(W * sizeof(Real)), aligned(sizeof(Real)), may_alias));
};

template <class Real, int W>
PBF_HD Lanes<Real, W> max2(const Lanes<Real, W>& a, const Lanes<Real, W>& b) {
#if defined(__x86_64__) && !defined(__clang__)
  // GCC takes two instructions, a comparison and a choice. This one gives b, too, if a number is
  // NaN or both are zero.
  if constexpr (W * sizeof(Real) > 16) {
    typename Lanes<Real, W>::Vector r;
    if constexpr (sizeof(Real) == 4)
      asm("vmaxps %2, %1, %0" : "=v"(r) : "v"(a.v), "v"(b.v));
    else
      asm("vmaxpd %2, %1, %0" : "=v"(r) : "v"(a.v), "v"(b.v));
    return r;
  }
#endif
  return typename Lanes<Real, W>::Vector(a.v > b.v ? a.v : b.v);
}
template <class Real, int W>
PBF_HD Lanes<Real, W> min2(const Lanes<Real, W>& a, const Lanes<Real, W>& b) {
  return typename Lanes<Real, W>::Vector(a.v < b.v ? a.v : b.v);
}
template <class Real, int W>
PBF_HD Lanes<Real, W> choose(const LaneMask<Real, W>& c, const Lanes<Real, W>& a,
                             const Lanes<Real, W>& b) {
  return typename Lanes<Real, W>::Vector(c.v > c.half ? a.v : b.v);
}
template <class Real, int W>
PBF_HD Vec3<Lanes<Real, W>> operator*(Real s, const Vec3<Lanes<Real, W>>& a) {
  return Lanes<Real, W>(s) * a;
}
template <class Real, int W>
PBF_HD Vec2<Lanes<Real, W>> operator*(Real s, const Vec2<Lanes<Real, W>>& a) {
  return Lanes<Real, W>(s) * a;
}
template <class Real, int W>
PBF_HD Vec3<Lanes<Real, W>> mul_add(Real a, const Vec3<Lanes<Real, W>>& b,
                                    const Vec3<Lanes<Real, W>>& c) {
  return a * b + c;
}
template <class Real, int W>
PBF_HD Vec3<Lanes<Real, W>> mul_add(Real a, const Vec3<Lanes<Real, W>>& b, const Vec3<Real>& c) {
  return a * b + Vec3<Lanes<Real, W>>{c.x, c.y, c.z};
}
/// The compiler turns the loop into one instruction.
template <class Real, int W>
PBF_HD Lanes<Real, W> square_root(const Lanes<Real, W>& a) {
  typename Lanes<Real, W>::Vector r{};
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

/// In every block of four lanes: lane l from pattern(l), the lanes of b before those of c.
template <class Real, int W, class Pattern>
PBF_HD typename Lanes<Real, W>::Vector shuffled(const typename Lanes<Real, W>::Vector& b,
                                                const typename Lanes<Real, W>::Vector& c, Pattern) {
  return [&]<int... l>(std::integer_sequence<int, l...>) __attribute__((always_inline)) {
    constexpr Pattern pattern{};
    return typename Lanes<Real, W>::Vector(__builtin_shufflevector(
        b, c, (pattern(l % 4) % 4 + l / 4 * 4 + (pattern(l % 4) >= 4 ? W : 0))...));
  }
  (std::make_integer_sequence<int, W>{});
}

/// Patterns that transpose every block of 4 x 4: pairs of rows, then pairs of those.
namespace block {
inline constexpr auto low = [](int l) { return l / 2 + 4 * (l % 2); };       // 0 4 1 5
inline constexpr auto high = [](int l) { return l / 2 + 2 + 4 * (l % 2); };  // 2 6 3 7
inline constexpr auto first = [](int l) { return l % 2 + 4 * (l / 2); };     // 0 1 4 5
inline constexpr auto second = [](int l) { return l % 2 + 2 + 4 * (l / 2); };
}  // namespace block

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
    // Pairs of rows into xy and zw, then pairs of those.
    const Vector xy0 = shuffled<Real, W>(row[0], row[1], block::low);
    const Vector xy1 = shuffled<Real, W>(row[2], row[3], block::low);
    const Vector zw0 = shuffled<Real, W>(row[0], row[1], block::high);
    const Vector zw1 = shuffled<Real, W>(row[2], row[3], block::high);
    r.x = shuffled<Real, W>(xy0, xy1, block::first);
    r.y = shuffled<Real, W>(xy0, xy1, block::second);
    r.z = shuffled<Real, W>(zw0, zw1, block::first);
    r.w = shuffled<Real, W>(zw0, zw1, block::second);
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
}  // namespace pbf::PBF_VARIANT
