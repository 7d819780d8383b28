// Typed access to the rows of an array: which rows a pass may access through a member. A pass is
// called for row i (an int); lists give rows of other particles (Neighbor). The types compile to
// plain pointers and numbers.
#pragma once

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

/// The row of another particle, from a neighbor list. An int does not convert to it.
struct Neighbor {
  int row;
};

/// An array of which a pass accesses only the row that it is called for. T const: read-only.
template <class T>
class OwnRows {
 public:
  OwnRows() = default;
  PBF_HD explicit OwnRows(T* rows) : rows_(rows) {}
  PBF_HD T& operator[](int i) const { return rows_[i]; }
  PBF_HD T* rows() const { return rows_; }  ///< for executors and load()

 private:
  T* rows_ = nullptr;
};

/// Row i of an array that a pass may also write, and its change. kernels/lane_groups.h has both
/// for several rows.
template <class T>
PBF_HD T row(OwnRows<T> a, int i) {
  return a[i];
}
template <class T>
PBF_HD void set_row(OwnRows<T> a, int i, const T& value) {
  a[i] = value;
}

/// A read-only array of which a pass also reads rows of neighbors.
template <class T>
class GatheredRows : public OwnRows<const T> {
 public:
  using OwnRows<const T>::OwnRows;
  using OwnRows<const T>::operator[];
  PBF_HD const T& operator[](Neighbor j) const { return this->rows()[j.row]; }
};

}  // namespace pbf::PBF_VARIANT
