// Asks runs to stop or to save their state.
#pragma once

#include <atomic>

namespace pbf::inline run_module {

/// Of one run. Several may share it to be stopped, but only one of them learns that it is to save.
/// Any thread may call every function, a signal handler too.
class StopToken {
 public:
  /// To stop. `why` is a literal ("SIGTERM"); the first one stays.
  void ask(const char* why) noexcept {
    const char* none = nullptr;
    why_.compare_exchange_strong(none, why);
  }
  /// To save, and go on.
  void ask_save() noexcept { save_ = true; }
  /// Null: nobody has asked to stop.
  const char* why() const noexcept { return why_; }
  /// Whether somebody has asked to save since the last call.
  bool take_save() noexcept { return save_.exchange(false); }

 private:
  static_assert(std::atomic<const char*>::is_always_lock_free);
  static_assert(std::atomic<bool>::is_always_lock_free);
  std::atomic<const char*> why_{nullptr};
  std::atomic<bool> save_{false};
};

}  // namespace pbf::inline run_module
