// The declarations of a pass about every array that it touches. Memory, plan, trace and the launch
// itself (granted.h) follow from them.
#pragma once

#include <type_traits>
#include <vector>

#include "lib/program/field.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// What a pass does with a field. A pass with several launches may combine these.
enum How : unsigned {
  kReads = 1,    ///< reads its own row
  kGathers = 2,  ///< reads rows of neighbors and its own
  kLooks = 4,    ///< reads any row
  kWrites = 8,   ///< writes its own row completely
  kPlaces = 16,  ///< writes any row, each once; later launches of the pass may read them
  kAdds = 32,    ///< adds integers to any row, in any order; with kPlaces: see Totals
  kUpdates = kReads | kWrites,
  kReading = kReads | kGathers | kLooks,
  kWriting = kWrites | kPlaces | kAdds
};

/// Contents of the fourth component of a position. mark: -1 if the particle is so fast that it may
/// move through a neighbor (kernels/relative_motion.h), otherwise 1.
enum class W { any, mark, lambda, inverse_density };

/// When a pass needs the field.
enum class When { always, first_iteration };

/// The division of an update, how often its iterations may be repeated, and in which form neighbors
/// are gathered.
struct UpdateShape {
  int substeps = 1, lists_per_update = 1, repeats = 0;
  bool packed = false;  ///< packs_rows()
};
inline bool is_packed(const UpdateShape& shape) { return shape.packed; }
inline bool is_not_packed(const UpdateShape& shape) { return !shape.packed; }

/// What declarations depend on.
struct Declarer {
  const Scene& scene;
  const UpdateShape& shape;
};

struct AccessInfo {
  const FieldInfo* field;
  unsigned how;
  W w = W::any;
  When when = When::always;
};

/// The two arrays of a field that sorts carry along.
struct CarriedField {
  const FieldInfo *first, *second;
};

template <auto& F, unsigned how_, W w_ = W::any, When when_ = When::always>
struct Access {
  using Field = std::remove_cvref_t<decltype(F)>;
  static constexpr unsigned how = how_;
  static void list(const Declarer&, std::vector<AccessInfo>& to) {
    to.push_back({&F, how_, w_, when_});
  }
  template <class Asked>
  static constexpr unsigned how_of() {
    return std::is_same_v<Asked, Field> ? how_ : 0;
  }
  static constexpr bool carries_fields = field::is_carried_field(F);
  static void list_carried(std::vector<CarriedField>& to) {
    if constexpr (carries_fields) to.push_back({&F, &other<F>});
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
/// Places sums over particles, which later launches of the pass read.
template <auto& F>
using Totals = Access<F, kPlaces | kAdds>;

/// A group of declarations, which may hold further groups.
template <class... As>
struct Needs {
  static void list(const Declarer& of, std::vector<AccessInfo>& to) { (As::list(of, to), ...); }
  template <class Asked>
  static constexpr unsigned how_of() {
    return (0u | ... | As::template how_of<Asked>());
  }
  static constexpr bool carries_fields = (false || ... || As::carries_fields);
  static void list_carried(std::vector<CarriedField>& to) { (As::list_carried(to), ...); }
};
/// Declarations for scenes for which on(scene) is true, or on(shape).
template <auto on, class... As>
struct If : Needs<As...> {
  static void list(const Declarer& of, std::vector<AccessInfo>& to) {
    if (is_on(of)) Needs<As...>::list(of, to);
  }

 private:
  static bool is_on(const Declarer& of) {
    if constexpr (requires { on(of.shape); })
      return on(of.shape);
    else
      return on(of.scene);
  }
};
/// Declarations of a fused pass, which does the work of A and then of B for each row. If A writes a
/// row and B reads the same row, the fused pass need not read it.
template <class A, class B>
struct Then : Needs<A, B> {
  static void list(const Declarer& of, std::vector<AccessInfo>& to);
  template <class Asked>
  static constexpr unsigned how_of() {
    constexpr unsigned a = A::template how_of<Asked>(), b = B::template how_of<Asked>();
    static_assert(!((a & (kWrites | kPlaces)) && (b & (kGathers | kLooks))),
                  "one launch writes a field and gathers it: its threads would race");
    return a | b;
  }
};

/// The two arrays of these fields are swapped before the pass is launched.
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
void Then<A, B>::list(const Declarer& of, std::vector<AccessInfo>& to) {
  std::vector<AccessInfo> a, b;
  A::list(of, a);
  B::list(of, b);
  for (const AccessInfo& x : a) to.push_back(x);
  for (AccessInfo x : b) {
    for (const AccessInfo& before : a)
      if (before.field == x.field && before.how == kWrites) x.how &= ~unsigned(kReads);
    if (x.how) to.push_back(x);
  }
}

/// Whether passes have the fast form of the GPU in float.
inline bool is_fast_on_gpu(const Scene& s) {
  return s.backend == Backend::cuda && s.precision == Precision::single && !s.solver.reproducible;
}

/// Whether particles come or go.
inline bool changes_rows(const Scene& s) {
  return s.capacity > 0 || !s.emitters.empty() || !s.sinks.empty();
}

/// The flags that pass P declares for a field; 0: none.
template <class P, class Field>
constexpr unsigned how_of = P::Needs::template how_of<Field>();

}  // namespace pbf::program_module
