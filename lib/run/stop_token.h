// Asks runs to stop or to save their state.
#pragma once

#include <atomic>

namespace pbf::run_module {

/// Of one run. Several may share it to be stopped, but only one of them learns that it is to save.
/// Any thread may call every function, a signal handler too.
class StopToken {
 public:
  /// Asks to stop. `why` is a string literal ("SIGTERM"); the first one is kept.
  void ask(const char* why) noexcept {
    const char* none = nullptr;
    why_.compare_exchange_strong(none, why);
  }
  /// Asks to save and continue.
  void ask_save() noexcept { save_ = true; }
  /// The reason to stop; null if nobody has asked.
  const char* why() const noexcept { return why_; }
  /// Whether a save was requested since the last call.
  bool take_save() noexcept { return save_.exchange(false); }

 private:
  static_assert(std::atomic<const char*>::is_always_lock_free);
  static_assert(std::atomic<bool>::is_always_lock_free);
  std::atomic<const char*> why_{nullptr};
  std::atomic<bool> save_{false};
};

}  // namespace pbf::run_module
