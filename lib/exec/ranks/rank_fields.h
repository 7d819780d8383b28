// What ranks do with whole arrays of a solver. c: a StepContext.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/pass_rank_rows.h"
#include "lib/base/error.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/program/exchanges.h"
#include "lib/program/features/solids.h"

namespace pbf::PBF_VARIANT {

/// The fields that go to other ranks in a sort, before the launch of the pass. A pass that does
/// more than sort may have written some into the second array of a pair that it does not flip.
/// Throws Error(internal) if there are too many.
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

template <class C>
std::size_t bytes_in_all(C& c, const FieldInfo& f) {
  return std::size_t(c.rows_of(f)) * std::size_t(f.bytes(C::precision));
}
template <class C>
void clear_field(C& c, const FieldInfo& f) {
  if (char* at = c.bytes_of(f)) c.exec.clear(at, bytes_in_all(c, f));
}
template <class Int, class C>
void add_up_field_as(C& c, const FieldInfo& f, Communicator& ranks) {
  auto* at = reinterpret_cast<Int*>(c.bytes_of(f));
  std::vector<Int> mine(bytes_in_all(c, f) / sizeof(Int));
  c.exec.to_host(at, mine.size(), mine.data());
  std::vector<std::int64_t> sums(mine.begin(), mine.end());
  ranks.sum(sums);
  std::copy(sums.begin(), sums.end(), mine.begin());
  c.exec.to_device(mine.data(), mine.size(), at);
}
/// Its numbers become their sums over all ranks. Throws Error(internal) if they are not whole.
template <class C>
void add_up_field(C& c, const FieldInfo& f, Communicator& ranks) {
  if (f.type == Type::int64) return add_up_field_as<std::int64_t>(c, f, ranks);
  if (f.type == Type::int32) return add_up_field_as<std::int32_t>(c, f, ranks);
  throw Error(ExitCode::internal, "only whole numbers add up");
}

/// No row counts as near a solid. The features mark those that they know of, which are not all
/// for which there is memory.
template <class C>
void forget_near(C& c) {
  using Real = typename C::Real;
  auto* way = c.data(field::near_way_left);
  if (!way) return;
  int* count = c.data(field::near_count);
  c.exec.all_listed(count, c.capacity(),
                    LeaveNearPass<Real>{c.data(field::near_row), reinterpret_cast<Real*>(way)});
  c.exec.clear(reinterpret_cast<char*>(count), sizeof *count);
}

}  // namespace pbf::PBF_VARIANT
