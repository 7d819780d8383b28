// The launch of a pass.
#pragma once

#include "lib/solver/granted.h"
#include "lib/solver/turns.h"

namespace pbf::PBF_VARIANT {

template <class P, class C>
void launch_one(C& c) {
  constexpr bool has_ranks = requires { c.exec.template before<P>(c); };
  if constexpr (has_ranks)
    if (!c.exec.template before<P>(c)) return;
  swap_arrays<P>(c);
  if (!take_turn<P>(c)) c.template as_pass<P>([](const auto& granted) { P::launch(granted); });
  if constexpr (C::changes_rows && (how_of<P, field::RowNumber> & kWriting) != 0)
    c.exec.rows_changed();
  if constexpr (has_ranks) c.exec.after(c);
}
/// Launches pass `index` of a PassList.
template <class Passes, class C>
void launch_pass(int index, C& c) {
  [&]<class... Ps>(PassList<Ps...>) {
    static constexpr void (*all[])(C&) = {&launch_one<Ps, C>...};
    all[index](c);
  }(Passes{});
}

}  // namespace pbf::PBF_VARIANT
