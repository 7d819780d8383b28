// The argument of a pass's launch(): the arrays that the pass declares, with the declared access,
// and functions that launch kernels.
#pragma once

#include "kernels/rows.h"
#include "lib/program/pass.h"
#include "lib/solver/step_context.h"

namespace pbf::inline PBF_VARIANT {

/// The type of a row of a field.
template <class Real>
Vec4<Real> row_of(const Vectors&);
template <class Real>
Real row_of(const Numbers&);
template <class Real, class T, int count, class Word>
T row_of(const Plain<T, count, Word>&);
template <class Field, class Real>
using RowOf = decltype(row_of<Real>(std::declval<const Field&>()));

/// Running sums. Only passes of whole numbers get their address, to add to them.
template <class T>
class Sums {
 public:
  explicit Sums(T* sums) : sums_(sums) {}
  T* sums() const { return sums_; }

 private:
  T* sums_;
};

/// A pass may touch only what it declares.
template <class Field, class P>
concept DeclaredBy = how_of<P, std::remove_cvref_t<Field>>
!= 0;

template <class C, class P>
class Granted {
 public:
  using Real = typename C::Real;
  using Lists = typename C::Lists;
  explicit Granted(C& c) : p(c.p), scene(c.scene), c_(c) {}

  const Params<Real>& p;
  const Scene& scene;  ///< along the internal axes, with the present step, SI units

  /// The array of a field. Null if the field is declared in an If<> that is false for the scene.
  template <class Field>
  requires DeclaredBy<Field, P>
  auto operator[](const Field& f) const {
    constexpr unsigned how = how_of<P, Field>;
    using Row = RowOf<Field, Real>;
    Row* rows = c_.template data<Row>(f);
    if constexpr (how == kAdds)
      return Sums<Row>(rows);
    else if constexpr ((how & kPlaces) != 0)
      return rows;
    else if constexpr ((how & kWrites) != 0)
      return OwnRows<Row>(rows);
    else if constexpr ((how & kGathers) != 0)
      return GatheredRows<Row>(rows);
    else if constexpr ((how & kReads) != 0)
      return OwnRows<const Row>(rows);
    else
      return static_cast<const Row*>(rows);
  }
  const Lists& lists() const requires DeclaredBy<decltype(field::lists), P> { return c_.lists; }
  // Launches by the shape of a pass (kernels/pass_shapes.h), over all rows or n items.
  template <class Pass>
  void items(const Pass& pass) const {
    c_.items(pass);
  }
  template <class Pass>
  void items(int n, const Pass& pass) const {
    c_.items(n, pass);
  }
  template <class Pass>
  void pairs(const Pass& pass) const {
    c_.pairs(pass);
  }
  template <class Pass>
  void shared(int n, const Pass& pass) const {
    c_.shared(n, pass);
  }
  template <class Pass>
  void teams(const Pass& pass) const {
    c_.teams(pass);
  }
  template <class Pass>
  void bricks(const Pass& pass) const {
    c_.bricks(pass);
  }
  template <class Pass>
  void listed(const int* count, const Pass& pass) const {
    c_.listed(count, pass);
  }
  template <class F>
  void with_smoothing(F&& f) const {
    c_.with_smoothing(f);
  }
  int rows() const { return c_.rows(); }
  /// For parts of the step that are no fields: solids, motion, gauges, counts.
  C& context() const { return c_; }

 private:
  C& c_;
};

template <class P, class C>
void launch_one(C& c) {
  if constexpr (requires { typename P::Flips; }) P::Flips::flip(c);
  const auto launch = [&] { P::launch(Granted<C, P>(c)); };
  // Only the executor of a test watches the memory that a pass accesses.
  if constexpr (requires { c.exec.watched(P::text.name, c.arrays(), launch); })
    c.exec.watched(P::text.name, c.arrays(), launch);
  else
    launch();
}
/// Launches pass `index` of a PassList.
template <class Passes, class C>
void launch_pass(int index, C& c) {
  [&]<class... Ps>(PassList<Ps...>) {
    static constexpr void (*all[])(C&) = {&launch_one<Ps, C>...};
    all[index](c);
  }(Passes{});
}

}  // namespace pbf::inline PBF_VARIANT
