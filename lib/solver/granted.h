// The argument of a pass's launch(): the arrays that the pass declares, with the declared access,
// and functions that launch kernels.
#pragma once

#include "kernels/rows.h"
#include "lib/program/pass.h"
#include "lib/solver/step_context.h"

namespace pbf::PBF_VARIANT {

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
concept DeclaredBy = (how_of<P, std::remove_cvref_t<Field>> != 0);

template <class C, class P>
class Granted {
 public:
  using Real = typename C::Real;
  using Lists = typename C::Lists;
  using Exec = std::remove_reference_t<decltype(std::declval<C>().exec)>;
  static constexpr bool changes_rows = C::changes_rows;
  explicit Granted(C& c) : p(c.p), scene(c.scene), plan(c.plan), exec(c.exec), c_(c) {}

  const Params<Real>& p;
  const Scene& scene;  ///< with the present step, SI units
  const Plan& plan;
  Exec& exec;

  /// The array of a field. Null if the field is declared in an If<> that is false for the scene.
  template <class Field>
  requires DeclaredBy<Field, P>
  auto operator[](const Field& f) const {
    constexpr unsigned how = how_of<P, Field>;
    using Row = RowOf<Field, Real>;
    Row* rows = c_.data(f);
    if constexpr (how == kAdds)
      return Sums<Row>(rows);
    else if constexpr ((how & (kPlaces | kAdds)) != 0)
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
  /// The same as an address, for structs that several passes share; null if the pass does not
  /// declare the field.
  template <class Field>
  RowOf<Field, Real>* declared(const Field& f) const {
    if constexpr (DeclaredBy<Field, P>)
      return c_.data(f);
    else
      return nullptr;
  }
  const Lists& lists() const requires DeclaredBy<decltype(field::lists), P> { return c_.lists; }
  /// The memory of a feature (lib/program/feature.h).
  template <class F>
  const auto& memory() const {
    return c_.template memory<F>();
  }
  Real sor() const { return c_.factors[std::size_t(c_.iteration)]; }
  const char* booked(const char* stage) const { return c_.booked(stage); }
  auto rows() const { return c_.rows(); }  ///< the number of particles, for launches
  int capacity() const { return c_.capacity(); }
  void make_lists() const requires((how_of<P, field::NeighborLists> & kWrites) != 0) {
    c_.make_lists();
  }
  int* sort_order() const requires DeclaredBy<field::Order, P> { return c_.sort_order(); }
  auto carried() const requires reorders<P> {
    if constexpr (C::Passes::carries_fields)
      return c_.carried();
    else
      return NothingCarried{};
  }

  // Launches by the shape of a pass (kernels/pass_shapes.h), over all rows or n items.
  void items(const auto& pass) const { exec.items(rows(), pass); }
  void items(int n, const auto& pass) const { exec.items(n, pass); }
  void pairs(const auto& pass) const { exec.pairs(rows(), pass); }
  void shared(int n, const auto& pass) const { exec.shared(n, pass); }
  void teams(const auto& pass) const { exec.teams(pass); }
  void bricks(const auto& pass) const { exec.bricks(pass); }
  void listed(const int* count, const auto& pass) const { exec.listed(count, capacity(), pass); }
  MeasureSums reduce(const auto& pass) const { return exec.reduce(c_.host_rows(), pass); }
  void with_smoothing(auto&& f) const {
    pbf::with_smoothing(scene.solver.kernels, scene.dimensions, f);
  }

 private:
  C& c_;
};

/// Swaps the arrays that pass P swaps before its launch.
template <class P, class C>
void swap_arrays(C& c) {
  if constexpr (requires { typename P::Flips; }) P::Flips::flip(c);
  if constexpr (C::Passes::carries_fields && reorders<P>) c.flip_carried();
}

template <class RealType, class Exec, class FeatureSet>
template <class P>
void StepContext<RealType, Exec, FeatureSet>::as_pass(const auto& launch) {
  const auto granted = [&] { launch(Granted<StepContext, P>(*this)); };
  // Only the executor of a test watches the memory that a pass accesses.
  const auto info = [&] { return info_of<P>({scene, plan.shape()}); };
  if constexpr (requires { exec.watched(info(), arrays(), granted); })
    exec.watched(info(), arrays(), granted);
  else
    granted();
}

}  // namespace pbf::PBF_VARIANT
