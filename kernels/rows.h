// Typed rows of an array: what a pass may reach through each of its members. A pass is called for
// row i (an int); a list gives rows of others (Neighbor). In machine code both are one pointer or
// one number.
#pragma once

#include "kernels/hd.h"

namespace pbf::inline PBF_VARIANT {

/// The row of another particle, as a neighbor list gives it. No number becomes one by itself.
struct Neighbor {
  int row;
};

/// An array of which a pass reaches the row that it is called for. T const: it only reads.
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

/// An array of which it also reads rows of neighbors.
template <class T>
class GatheredRows : public OwnRows<const T> {
 public:
  using OwnRows<const T>::OwnRows;
  using OwnRows<const T>::operator[];
  PBF_HD const T& operator[](Neighbor j) const { return this->rows()[j.row]; }
};

}  // namespace pbf::inline PBF_VARIANT
