// Many particles on a GPU: neighbor sums gather packed rows (kernels/packed_position.h,
// kernels/packed_motion.h).
#pragma once

#include "kernels/packed_position.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

/// More particles than this are packed: with fewer, gathers are not what limits a GPU.
inline constexpr std::int64_t kMostUnpacked = 100000;

/// Whether rows are packed. It follows from the scene, not from the card or the number of ranks,
/// because packed sums have other bits. Neighbors must be at the positions of their rows (images
/// are not), which no pass but those of motion and correction may move.
bool packs_rows(const Scene& scene, const Plan& plan);

namespace field {
/// The positions once more, for lambda.
inline constexpr struct PackedPositions : Plain<PackedPosition, 1, std::int64_t> {
} packed_position{{"packed position", per_padded_row, Life::pass}};
}  // namespace field
/// Of a pass that writes positions.
using PacksPositions = If<is_packed, Writes<field::packed_position>>;
using PlacesPacked = If<is_packed, Places<field::packed_position>>;

}  // namespace pbf::program_module

namespace pbf::PBF_VARIANT {

/// Whether an executor has passes of packed rows.
template <class G>
constexpr bool has_packed_rows = requires {
  std::decay_t<decltype(std::declval<const G&>().exec)>::packed_rows;
}
&&sizeof(typename G::Real) == 4;

/// The positions that a pass writes, together with their packed rows.
template <class G>
MovedRows<typename G::Real> moved_rows(const G& c) {
  using Rows = OwnRows<Vec4<typename G::Real>>;
  MovedRows<typename G::Real> rows{Rows(c.declared(field::position))};
  if constexpr (requires { rows.packed; }) rows.packed = c.declared(field::packed_position);
  return rows;
}

}  // namespace pbf::PBF_VARIANT
