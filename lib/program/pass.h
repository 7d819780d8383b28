// The description of a pass, and lists of passes as types. A pass is a struct with
//   static constexpr PassText text{name, stage, remedy};
//   using Needs = pbf::Needs<...>;                       // needs.h
//   template <class G> static void launch(const G& c);   // c: granted.h
// A pass that writes into the other array of a pair and leaves it as the first one also has
// `using Flips = pbf::Flips<...>`; its Needs call it by the name that it has then. A pass that does
// the work of two successive ones has `using Fuses = Pair<First, Second>`.
#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "lib/program/needs.h"

namespace pbf::inline program_module {

struct PassText {
  const char* name;         ///< in `pbf plan`
  const char* stage;        ///< a row of lib/base/stages.h: where its time is booked
  const char* remedy = "";  ///< "lower viscosity.xsph", where particles go wrong here; empty: none
                            ///< of its own, but those of the whole step
};

/// What a pass leaves behind in a field, as those see it who look at an update pass by pass.
struct Written {
  enum Part { vector, fourth, scalar, pairs };
  const FieldInfo* field;
  Part part;
  const char *quantity, *unit;
  const char* stage;  ///< not null: shown as that of another stage than the pass's
  bool sum = false;   ///< over neighbors: carries the rounding of its terms
};

struct PassInfo : PassText {
  std::vector<AccessInfo> needs;     ///< each field once; w: what the pass leaves there
  std::vector<AccessInfo> declared;  ///< the same in order, as the pass says it
  std::vector<const FieldInfo*> flips;
  std::vector<Written> written;
  int stored = -1;  ///< of `written`: what a fault that is no number is put into; -1: velocity

  bool makes_lists() const;
  bool over_pairs() const;  ///< uses the lists
};

/// With what follows from the declarations.
PassInfo described(const PassText& text, std::vector<AccessInfo> declared,
                   std::vector<const FieldInfo*> flips);

/// Of pass P in a scene.
template <class P>
PassInfo info_of(const Scene& scene) {
  std::vector<AccessInfo> declared;
  P::Needs::list(scene, declared);
  if constexpr (requires { typename P::Flips; })
    return described(P::text, std::move(declared), P::Flips::list());
  else
    return described(P::text, std::move(declared), {});
}

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
  static std::vector<PassInfo> infos(const Scene& scene) { return {info_of<Ps>(scene)...}; }
  static constexpr std::array<PassText, sizeof...(Ps)> texts{Ps::text...};
  /// The one that does the work of passes a and b, or -1.
  static int fused(int a, int b) {
    int found = -1;
    ((fuses<Ps>(a, b) ? void(found = index_of<Ps>()) : void()), ...);
    return found;
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
