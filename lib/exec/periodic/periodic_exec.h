// The executor of scenes with periodic axes: passes run for particles, not for their images
// (periodic_rows.h). In other scenes it is its base. Base: RankExec.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "kernels/pass_residual.h"
#include "kernels/pass_shapes.h"
#include "lib/exec/periodic/periodic_rows.h"

namespace pbf::PBF_VARIANT {

template <class Base>
class PeriodicExec : public Base {
 public:
  using typename Base::Lists;
  struct Rows : Base::Rows {
    const int* id = nullptr;  ///< of all rows if some are images
    operator RowRange() const { return {this->first, this->last, id, this->state}; }
  };

  template <class... Args>
  explicit PeriodicExec(bool periodic, Args&&... of_base)
      : Base(std::forward<Args>(of_base)...),
        images_(periodic ? std::make_unique<PeriodicRows<Base>>() : nullptr) {}
  /// Null without periodic axes.
  PeriodicRows<Base>* images() { return images_.get(); }

  Rows counted(const RowState* state, int launched) const {
    if (!images_) return {Base::counted(state, launched)};
    return {{0, images_->all(), images_->all(), true, nullptr}, images_->ids()};
  }

  using Base::items, Base::pairs, Base::build_lists, Base::repeat_while;
  /// Without images the launch is that of the rank, which may split it (RankExec::over()).
  template <ItemPass Pass>
  void items(const Rows& rows, const Pass& pass) {
    images_ ? Base::items(RowRange(rows), pass) : Base::items(of_rank(rows), pass);
  }
  template <PairPass Pass>
  void pairs(const Rows& rows, const Pass& pass) {
    images_ ? Base::pairs(RowRange(rows), pass) : Base::pairs(of_rank(rows), pass);
  }
  /// Rows near solids are listed with those of images.
  template <ItemPass Pass>
  void listed(const int* count, int most, const Pass& pass) {
    if constexpr (requires { pass.row(0); })
      Base::listed(count, most, ListedWithoutImages<Pass>{pass, ids()});
    else
      Base::listed(count, most, pass);
  }
  template <class Real>
  Lists build_lists(const Rows& rows, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    return Base::build_lists(RowRange(rows), far, position, bin_start, p);
  }

  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    return Base::reduce(all(n), WithoutImages<Pass>{pass, ids()});
  }
  template <class Pass>
  std::vector<std::int64_t> count_in_bins(int n, int bins, const Pass& pass) {
    return Base::count_in_bins(all(n), bins, WithoutImages<Pass>{pass, ids()});
  }
  template <class Pass, class Body>
  void repeat_while(const char* stage, const Rows& rows, int times, const Pass& pass,
                    double tolerance, unsigned long long* repeats, const Body& body) {
    if (!images_)
      return Base::repeat_while(stage, of_rank(rows), times, pass, tolerance, repeats, body);
    this->repeat_from_host(
        stage, times, residual_limit(tolerance, images_->particles()), repeats,
        [&] {
          return Base::sum_of(rows.all, WithoutImages<Pass>{pass, rows.id});
        },
        body);
  }
  template <class Updates>
  void repeat(int updates, Updates& u) {
    if (images_)
      Base::repeat_unrecorded(updates, u);
    else
      Base::repeat(updates, u);
  }

  std::size_t bytes() const { return Base::bytes() + (images_ ? images_->bytes() : 0); }

  template <class P, class C>
  bool before(C& c) {
    if (!images_) return Base::template before<P>(c);
    images_->template before<P>(c);
    if (images_->copied()) this->mark("exchange");
    return true;
  }
  template <class C>
  void after(C& c) {
    if (images_) return images_->after(c);
    Base::after(c);
  }

 private:
  /// As the type of the base: it has other overloads for any type.
  static const typename Base::Rows& of_rank(const Rows& rows) { return rows; }
  int all(int n) const { return images_ ? images_->all() : n; }
  const int* ids() const { return images_ ? images_->ids() : nullptr; }

  std::unique_ptr<PeriodicRows<Base>> images_;
};

}  // namespace pbf::PBF_VARIANT
