// Starts threads, with a clear error when the system refuses more.
#pragma once

#include <system_error>
#include <thread>
#include <utility>

namespace pbf::inline base_module {

/// Throws Error(unavailable) that names the limit and the remedy.
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

/// 0 when so many threads, the calling one among them, can run at once; else the system's reason.
int reason_against_threads(int threads);

/// Throws Error(unavailable) when so many threads, the calling one among them, cannot run at once.
/// To be asked before OpenMP starts a team: its runtime ends the program.
void require_threads(int threads);

}  // namespace pbf::inline base_module
