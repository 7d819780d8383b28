// Passes that run while lists are made, where the executor can run launches beside each other: they
// follow the lists in an update, and by their declarations neither needs the other.
#pragma once

#include <algorithm>
#include <vector>

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

/// The passes that run beside others, from the lists on until a pass needs what they write.
class PassesBeside {
 public:
  /// Runs steps[k] beside the passes that follow, if it makes lists, there are some, and the
  /// executor can; k is then the last of them. launch(pass): by its index. Otherwise nothing has
  /// run.
  template <class C>
  bool start(C& c, const Steps& steps, std::size_t& k, const auto& launch) {
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
      for (std::size_t n = 1; n <= others; ++n) under_way_.push_back(steps[k + n].index);
      k += others;
      return true;
    } else {
      return false;
    }
  }
  /// launch(), of this pass: at once if it needs nothing of those under way, else after them.
  template <class C>
  void with(C& c, int pass, const auto& launch) {
    if constexpr (requires { c.exec.has_beside(); }) {
      const auto& all = c.plan.program.passes;
      const bool needs_none = std::ranges::all_of(under_way_, [&](int other) {
        return are_independent(all[std::size_t(pass)], all[std::size_t(other)]);
      });
      if (needs_none && !under_way_.empty()) return c.exec.meanwhile(launch);
      under_way_.clear();
    }
    launch();
  }

 private:
  std::vector<int> under_way_;
};

}  // namespace pbf::PBF_VARIANT
