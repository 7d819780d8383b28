// The arrays of the rows that go to other ranks within a sort.
#pragma once

#include <algorithm>

#include "kernels/pass_rank_rows.h"
#include "lib/base/error.h"
#include "lib/program/exchanges.h"

namespace pbf::PBF_VARIANT {

/// The fields before a launch of the pass, which sorts. c: a StepContext. A pass that does more
/// than sort may have written some into the second array of a pair that it does not flip. Throws
/// Error(internal) if there are too many.
template <class C>
RowFields row_fields(C& c, const Exchange::Fields& fields, const PassInfo& pass) {
  const auto is_in_second = [&](const FieldInfo* f) {
    return std::ranges::find(pass.flips, f) == pass.flips.end() &&
           std::ranges::any_of(pass.declared, [&](auto& a) { return a.field->first == f; });
  };
  RowFields rows;
  if (fields.size() > std::size_t(RowFields::most))
    throw Error(ExitCode::internal, "too many fields go along with particles");
  for (const FieldInfo* f : fields) {
    const int k = rows.fields++;
    const bool second = is_in_second(f);
    if (second) c.flip(*f);
    rows.rows[k] = reinterpret_cast<std::uint32_t*>(c.bytes_of(*f));
    if (second) c.flip(*f);
    rows.begin[k + 1] = rows.begin[k] + f->bytes(C::precision) / 4;
  }
  return rows;
}

}  // namespace pbf::PBF_VARIANT
