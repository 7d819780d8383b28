// Passes that run while lists are made, where the executor can run launches beside each other: they
// follow the lists in an update, and by their declarations neither needs the other.
#pragma once

#include "lib/solver/turns.h"

namespace pbf::PBF_VARIANT {

/// How many passes behind the lists, steps[k], may run beside them, such as those that assign
/// particles to the cells of levels. They are short, so alone they would mostly wait.
template <class C>
std::size_t passes_beside(C& c, const Steps& steps, std::size_t k) {
  const auto pass = [&](std::size_t n) -> const PassInfo& {
    return c.plan.program.passes[std::size_t(steps[n].index)];
  };
  std::size_t end = k + 1;
  while (end < steps.size() && steps[end].kind == ProgramStep::pass &&
         are_independent(pass(k), pass(end)))
    ++end;
  return end - k - 1;
}

/// Runs steps[k] beside the passes that follow, if it makes lists, there are some, and the executor
/// can; k is then the last of them. launch(pass): by its index. Otherwise nothing has run.
template <class C>
bool with_lists(C& c, const Steps& steps, std::size_t& k, const auto& launch) {
  if constexpr (requires { c.exec.has_beside(); }) {
    if (!is_pass<MakeLists, C>(steps, k)) return false;
    if (has_other_ranks(c)) return false;  // the host takes part in making their lists
    const std::size_t others = passes_beside(c, steps, k);
    if (others == 0 || !c.exec.has_beside()) return false;
    c.exec.run_beside(
        [&] {
          for (std::size_t n = 1; n <= others; ++n) launch(steps[k + n].index);
        },
        [&] { launch(steps[k].index); });
    k += others;
    return true;
  } else {
    return false;
  }
}

}  // namespace pbf::PBF_VARIANT
