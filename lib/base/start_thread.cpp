#include "lib/base/start_thread.h"

#include <fmt/core.h>
#include <cstring>
#include <mutex>
#include <vector>

#include "lib/base/error.h"

namespace pbf::base_module {

void refuse_threads(int reason, int wanted) {
  throw Error(ExitCode::unavailable,
              fmt::format("{} cannot be started: {}; raise the limit on processes (ulimit -u, or "
                          "pids of a container), or use fewer --threads and --jobs",
                          wanted > 1 ? fmt::format("{} threads", wanted) : "a thread",
                          std::strerror(reason)));
}

int reason_against_threads(int threads) {
  std::mutex gate;
  std::vector<std::thread> all;
  int reason = 0;
  {
    const std::lock_guard closed(gate);  // no thread ends before the last has started
    try {
      for (int k = 1; k < threads; ++k)
        all.emplace_back([&gate] { const std::lock_guard open(gate); });
    } catch (const std::system_error& e) {
      reason = e.code().value();
    }
  }
  for (std::thread& t : all) t.join();
  return reason;
}

void require_threads(int threads) {
  if (const int reason = reason_against_threads(threads); reason != 0)
    refuse_threads(reason, threads);
}

}  // namespace pbf::base_module
