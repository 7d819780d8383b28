// The type of a row of a field in a precision.
#pragma once

#include <utility>

#include "lib/program/features.h"

namespace pbf::PBF_VARIANT {

// Those of Objects stand beside their fields.
template <class Real>
Vec4<Real> row_of(const Vectors&);
template <class Real>
Real row_of(const Numbers&);
template <class Real, class T, int count, class Word>
T row_of(const Plain<T, count, Word>&);

template <class Field, class Real>
using RowOf = decltype(row_of<Real>(std::declval<const Field&>()));

}  // namespace pbf::PBF_VARIANT
