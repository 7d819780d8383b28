// The description of a pass, and lists of passes as types. A pass is a struct with
//   static constexpr PassText text{name, stage, remedy};
//   using Needs = pbf::Needs<...>;                       // needs.h
//   static void launch(const auto& c);                   // c: granted.h
// A pass that swaps the two arrays of a pair before its launch also has
// `using Flips = pbf::Flips<...>`; its Needs name the arrays as they are after the swap. A pass
// that does the work of two successive ones has `using Fuses = Pair<First, Second>`.
#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "lib/program/needs.h"

namespace pbf::program_module {

struct PassText {
  const char* name;         ///< in `pbf plan`
  const char* stage;        ///< the row of lib/base/stages.h to which its time is booked
  const char* remedy = "";  ///< advice if particles become invalid in this pass, "lower
                            ///< viscosity.xsph"; empty: the general advice
};

/// A result of a pass in a field, as a trace of an update shows it.
struct Written {
  enum Part { vector, fourth, scalar, pairs };
  const FieldInfo* field;
  Part part;
  const char *quantity, *unit;
  const char* stage;  ///< not null: shown under this stage instead of the stage of the pass
  bool sum = false;   ///< a sum over neighbors, with the rounding errors of its terms
};

struct PassInfo : PassText {
  std::vector<AccessInfo> needs;     ///< each field once; w: what the pass leaves there
  std::vector<AccessInfo> declared;  ///< the same in order, as the pass says it
  std::vector<const FieldInfo*> flips;
  std::vector<Written> written;
  int stored = -1;  ///< index in `written`: where tests inject a non-finite value; -1: velocity

  bool makes_lists() const;
  bool leaves(W w) const;   ///< writes this into w of positions
  bool over_pairs() const;  ///< uses the lists
  bool reorders_rows() const;
};

/// Whether two passes may run at the same time: neither writes an array that the other one uses,
/// nor swaps arrays.
bool are_independent(const PassInfo& a, const PassInfo& b);

/// The description of a pass, with everything that follows from its declarations.
PassInfo described(const PassText& text, std::vector<AccessInfo> declared,
                   std::vector<const FieldInfo*> flips);

/// The description of pass P.
template <class P>
PassInfo info_of(const Declarer& of) {
  std::vector<AccessInfo> declared;
  P::Needs::list(of, declared);
  if constexpr (requires { typename P::Flips; })
    return described(P::text, std::move(declared), P::Flips::list());
  else
    return described(P::text, std::move(declared), {});
}

/// Whether pass P puts the particles into another order. It then reorders all carried fields.
template <class P>
constexpr bool reorders = (how_of<P, field::Id> & kPlaces) != 0;

template <class First, class Second>
struct Pair {
  template <class Passes>
  static bool is(int a, int b) {
    return Passes::template index_of<First>() == a && Passes::template index_of<Second>() == b;
  }
};

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
  static std::vector<PassInfo> infos(const Declarer& of) { return {info_of<Ps>(of)...}; }
  static constexpr std::array<PassText, sizeof...(Ps)> texts{Ps::text...};
  /// The carried fields of all passes besides position, velocity and id, in any scene.
  static constexpr bool carries_fields = (false || ... || Ps::Needs::carries_fields);
  static std::vector<CarriedField> carried_fields() {
    std::vector<CarriedField> all;
    (Ps::Needs::list_carried(all), ...);
    return all;
  }
  /// The index of the pass that does the work of passes a and b, or -1.
  static int fused(int a, int b) {
    int found = -1;
    const auto look = [&]<class P>(PassList<P>) {
      if constexpr (requires { typename P::Fuses; })
        if (P::Fuses::template is<PassList>(a, b)) found = index_of<P>();
    };
    (look(PassList<Ps>()), ...);
    return found;
  }
};

/// The concatenated pass lists of several features.
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

}  // namespace pbf::program_module
