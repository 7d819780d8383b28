// A copy of the state in the memory of an executor, from which later updates can be repeated.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/pass_copy.h"
#include "lib/solver/step_context.h"

namespace pbf::PBF_VARIANT {

template <class Exec>
class SavedState {
 public:
  bool empty() const { return copies_.empty(); }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& copy : copies_) sum += copy.bytes();
    return sum;
  }
  /// The copies, in the order of Program::state.
  std::vector<const char*> arrays() const {
    std::vector<const char*> all;
    for (const auto& copy : copies_) all.push_back(copy.data());
    return all;
  }
  template <class C>
  void save(C& c) {
    const auto& state = c.plan.program.state;
    copies_.resize(state.size());
    for (std::size_t k = 0; k < state.size(); ++k)
      copies_[k].resize(c.kept_rows(*state[k]) * std::size_t(state[k]->bytes(C::precision)));
    copy(c, [&](const FieldInfo& f, auto& saved) -> CopyPass::Part {
      return {c.bytes_of(f), saved.data(), std::int64_t(saved.bytes())};
    });
  }
  template <class C>
  void restore(C& c) {
    copy(c, [&](const FieldInfo& f, auto& saved) -> CopyPass::Part {
      return {saved.data(), c.bytes_of(f), std::int64_t(saved.bytes())};
    });
  }

 private:
  /// Copies all fields in one launch, because a run with a guard does so at every measurement.
  template <class C, class PartOf>
  void copy(C& c, const PartOf& part_of) {
    CopyPass pass;
    std::int64_t longest = 0;
    const auto launch = [&] {
      c.exec.items(int((longest + CopyPass::unit - 1) / CopyPass::unit), pass);
      pass.parts = 0;
      longest = 0;
    };
    for (std::size_t k = 0; k < copies_.size(); ++k) {
      pass.part[pass.parts++] = part_of(*c.plan.program.state[k], copies_[k]);
      longest = std::max(longest, std::int64_t(copies_[k].bytes()));
      if (pass.parts == CopyPass::most) launch();
    }
    if (pass.parts > 0) launch();
  }

  std::vector<typename Exec::template Buffer<char>> copies_;
};

}  // namespace pbf::PBF_VARIANT
