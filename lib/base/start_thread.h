// Starts threads, with a clear error if the system refuses.
#pragma once

#include <system_error>
#include <thread>
#include <utility>

namespace pbf::base_module {

/// Throws Error(unavailable), which names the limit and the remedy. reason: an errno.
[[noreturn]] void refuse_threads(int reason, int wanted);

/// A thread that runs `work`. Throws Error(unavailable).
template <class Work>
std::thread start_thread(Work&& work) {
  try {
    return std::thread(std::forward<Work>(work));
  } catch (const std::system_error& e) {
    refuse_threads(e.code().value(), 1);
  }
}

/// 0 if this number of threads, including the calling one, can run at once; otherwise the errno.
int reason_against_threads(int threads);

/// Throws Error(unavailable) if this number of threads, including the calling one, cannot run at
/// once. Call it before OpenMP starts a team: its runtime would end the program.
void require_threads(int threads);

}  // namespace pbf::base_module
