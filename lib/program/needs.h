// What a pass declares of every array that it touches. Memory, plan, trace, exchanges between ranks
// and the launch itself (granted.h) follow from it.
#pragma once

#include <type_traits>
#include <vector>

#include "lib/program/field.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// What a pass does with a field. A pass that consists of several launches may do more than one.
enum How : unsigned {
  kReads = 1,    ///< its own row
  kGathers = 2,  ///< rows of neighbors, and its own
  kLooks = 4,    ///< any row of a table
  kWrites = 8,   ///< its own row, all of it
  kPlaces = 16,  ///< rows anywhere, each once; may then read what it has placed
  kAdds = 32,    ///< adds whole numbers anywhere, in any order
  kUpdates = kReads | kWrites,
  kReading = kReads | kGathers | kLooks,
  kWriting = kWrites | kPlaces | kAdds
};

/// What the fourth component of a position holds. mark: -1 where a particle is so fast that it may
/// pass a neighbor (kernels/relative_motion.h), else 1.
enum class W { any, mark, lambda, inverse_density };

/// always, or in the first iteration of a substep alone.
enum class When { always, first_iteration };

struct AccessInfo {
  const FieldInfo* field;
  unsigned how;
  W w = W::any;
  When when = When::always;
};

template <auto& F, unsigned how_, W w_ = W::any, When when_ = When::always>
struct Access {
  using Field = std::remove_cvref_t<decltype(F)>;
  static constexpr unsigned how = how_;
  static void list(const Scene&, std::vector<AccessInfo>& to) {
    to.push_back({&F, how_, w_, when_});
  }
  template <class Asked>
  static constexpr unsigned how_of() {
    return std::is_same_v<Asked, Field> ? how_ : 0;
  }
};
template <auto& F, W w = W::any, When when = When::always>
using Reads = Access<F, kReads, w, when>;
template <auto& F, W w = W::any, When when = When::always>
using Gathers = Access<F, kGathers, w, when>;
template <auto& F>
using Looks = Access<F, kLooks>;
template <auto& F, W w = W::any>
using Writes = Access<F, kWrites, w>;
template <auto& F, W w = W::any>
using Updates = Access<F, kUpdates, w>;
template <auto& F, W w = W::any>
using Places = Access<F, kPlaces, w>;
template <auto& F>
using Adds = Access<F, kAdds>;

/// A group of declarations, which may hold further groups.
template <class... As>
struct Needs {
  static void list(const Scene& scene, std::vector<AccessInfo>& to) { (As::list(scene, to), ...); }
  template <class Asked>
  static constexpr unsigned how_of() {
    return (0u | ... | As::template how_of<Asked>());
  }
};
/// Declarations that hold in scenes of which `on` is true.
template <bool (*on)(const Scene&), class... As>
struct If {
  static void list(const Scene& scene, std::vector<AccessInfo>& to) {
    if (on(scene)) (As::list(scene, to), ...);
  }
  template <class Asked>
  static constexpr unsigned how_of() {
    return (0u | ... | As::template how_of<Asked>());
  }
};
/// Of one launch that does the work of A and then of B, row by row. What A writes and B reads of
/// the same row is no need of both.
template <class A, class B>
struct Then {
  static void list(const Scene& scene, std::vector<AccessInfo>& to);
  template <class Asked>
  static constexpr unsigned how_of() {
    constexpr unsigned a = A::template how_of<Asked>(), b = B::template how_of<Asked>();
    static_assert(!((a & (kWrites | kPlaces)) && (b & (kGathers | kLooks))),
                  "one launch writes a field and gathers it: its threads would race");
    return a | b;
  }
};

/// Before the pass is launched the two arrays trade places.
template <auto&... Fs>
struct Flips {
  template <class C>
  static void flip(C& c) {
    (c.flip(Fs), ...);
  }
  static std::vector<const FieldInfo*> list() { return {&Fs...}; }
};

/// The neighbor lists.
using UsesLists = Looks<field::lists>;
using MakesLists = Writes<field::lists>;

/// Joined per field, in the order of first mention; w: as it is written last.
std::vector<AccessInfo> joined(const std::vector<AccessInfo>& all);

template <class A, class B>
void Then<A, B>::list(const Scene& scene, std::vector<AccessInfo>& to) {
  std::vector<AccessInfo> a, b;
  A::list(scene, a);
  B::list(scene, b);
  for (const AccessInfo& x : a) to.push_back(x);
  for (AccessInfo x : b) {
    for (const AccessInfo& before : a)
      if (before.field == x.field && before.how == kWrites) x.how &= ~unsigned(kReads);
    if (x.how) to.push_back(x);
  }
}

/// What a pass that declares P::Needs does with a field; 0: nothing.
template <class P, class Field>
constexpr unsigned how_of = P::Needs::template how_of<Field>();

}  // namespace pbf::inline program_module
