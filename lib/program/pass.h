// The description of a pass, and lists of passes as types. A pass is a struct with
//   static PassInfo info();
//   template <class C> static void launch(C& c);   // c: lib/solver/step_context.h
// A pass that fuses two successive passes also has `using Fuses = Pair<First, Second>`.
#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "lib/program/field.h"

namespace pbf::inline program_module {

/// What a pass leaves behind in a field (where it lies after the pass), as those see it who look at
/// an update pass by pass.
struct Written {
  enum Part { hidden, vector, fourth, scalar, pairs };
  Access to;
  Part part = hidden;              ///< x, y, z; w; a number per particle; the lists
  const char* quantity = "";       ///< "position"
  const char* unit = "1";          ///< of the internal frame
  bool sum = false;                ///< over neighbours: carries the rounding of its terms
  bool axial = false;              ///< a cross product: its sign depends on the hand of the axes
  bool before_sort = false;        ///< its rows are in the order before the sort
  const char* stage = nullptr;     ///< shown as that of another stage than the pass's
  const FieldInfo* row = nullptr;  ///< not null: it names each particle's row, -1: none
  double grain = 0;                ///< in `unit`: finer steps than this it cannot make
};
inline Written vector(Access to, const char* quantity, const char* unit) {
  return {to, Written::vector, quantity, unit};
}
inline Written hidden(Access to) { return {to}; }

struct PassInfo {
  const char* name;   ///< in `pbf plan`
  const char* stage;  ///< a row of lib/base/stages.h: where its time is booked
  std::vector<Access> reads;
  std::vector<Written> writes;
  unsigned gathers = 0;  ///< Fields of neighbours' rows that it reads (kernels/pair_sum.h)
  int stored = -1;       ///< of `writes`: what a fault that is no number is put into; -1: velocity
  const char* remedy = "";  ///< "lower viscosity.xsph", where particles go wrong here; empty: none
                            ///< of its own, but those of the whole step
};

template <class First, class Second>
struct Pair {};

template <class... Ps>
struct PassList {
  static constexpr int size = sizeof...(Ps);
  template <class P>
  static constexpr int index_of() {
    const bool same[] = {std::is_same_v<P, Ps>...};
    int k = 0;
    while (!same[k]) ++k;
    return k;
  }
  static std::vector<PassInfo> infos() { return {Ps::info()...}; }
  /// The one that does the work of passes a and b, or -1.
  static int fused(int a, int b) {
    int found = -1;
    ((fuses<Ps>(a, b) ? void(found = index_of<Ps>()) : void()), ...);
    return found;
  }
  /// Launches pass `index`.
  template <class C>
  static void launch(int index, C& c) {
    static constexpr void (*all[])(C&) = {&Ps::template launch<C>...};
    all[index](c);
  }

 private:
  template <class A, class B>
  static bool is(Pair<A, B>, int a, int b) {
    return index_of<A>() == a && index_of<B>() == b;
  }
  template <class P>
  static bool fuses(int a, int b) {
    if constexpr (requires { typename P::Fuses; })
      return is(typename P::Fuses{}, a, b);
    else
      return false;
  }
};

/// The passes of several features one behind the other.
template <class... Lists>
struct Joined;
template <class... Ps>
struct Joined<PassList<Ps...>> {
  using type = PassList<Ps...>;
};
template <class... As, class... Bs, class... Rest>
struct Joined<PassList<As...>, PassList<Bs...>, Rest...> {
  using type = typename Joined<PassList<As..., Bs...>, Rest...>::type;
};

}  // namespace pbf::inline program_module
