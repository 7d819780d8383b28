// Passes that run beside each other, where launches can overlap.
#pragma once

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

/// Short passes in front of a neighbor sum that needs what they write only in its finish(): where
/// launches can overlap, the sum is added up beside them. Such a pass says its place as `chain`:
/// `first`: the ones behind it may begin as soon as everything before it is done; `inner`: they may
/// begin with it. The neighbor sum behind them says `finish_waits`.
enum class Chain { none, first, inner };
template <class P>
constexpr Chain chain_of() {
  if constexpr (requires { P::chain; }) return P::chain;
  return Chain::none;
}
template <class P>
constexpr bool finish_waits() {
  if constexpr (requires { P::finish_waits; }) return P::finish_waits;
  return false;
}

}  // namespace pbf::PBF_VARIANT
