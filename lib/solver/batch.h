// The updates of a batch, as executors run, record and replay them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

/// Steps with what comes between them (Program::between).
template <class Stepping>
class Batch {
 public:
  /// at: the steps that have been; every: from one time of the passes between steps to the next, 0
  /// if there are none.
  Batch(Stepping& stepper, std::int64_t at, std::int64_t every)
      : stepper_(stepper), at_(at), every_(every) {}

  int capacity() const { return stepper_.capacity(); }
  /// n steps, and what comes between and behind them.
  void step(std::int64_t n) {
    while (n > 0) {
      const std::int64_t part = std::min(n, to_next(n));
      stepper_.step(int(part));
      at_ += part, n -= part;
      if (comes_here()) stepper_.between();
    }
  }

  /// Whether n steps may be recorded at once. Few forms of n steps exist: without anything between
  /// them, with it behind the last one, or from one time of it on.
  bool has_form(int n) const { return comes_here() || n <= to_next(n); }
  /// What a recording of n steps from here on is valid for.
  auto recording(int n) const {
    const std::int64_t next = to_next(n + 1);
    const Form form = n < next ? Form::steps : n == next ? Form::and_between : Form::from_between;
    const auto [placement, rows] = stepper_.launch();
    return std::array{n, int(form), placement, rows};
  }
  /// A recording of n steps ran.
  void replayed(int n) {
    at_ += n;
    stepper_.moved();
  }

 private:
  enum class Form { steps, and_between, from_between };
  bool comes_here() const { return every_ != 0 && at_ % every_ == 0; }
  /// Steps until the passes between steps come again, if these are fewer than `most`.
  std::int64_t to_next(std::int64_t most) const {
    return every_ == 0 ? most : std::min(most, every_ - at_ % every_);
  }

  Stepping& stepper_;
  std::int64_t at_, every_;
};

}  // namespace pbf::PBF_VARIANT
