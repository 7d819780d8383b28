// Runs independent work on several threads, with progress, until a signal ends it.
#pragma once

#include <fmt/core.h>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "lib/base/log.h"
#include "lib/base/stage_clock.h"
#include "lib/base/text.h"

namespace pbf::app_module {

/// Calls work(k) for all k < n on `jobs` threads, with a line of progress after each: "k of n WHAT,
/// time" and name(row). work(k) returns std::optional<Row>; if it is empty, a signal has come and
/// no further work is started. The first exception is thrown at the end.
template <class Row, class Work, class Name>
std::vector<std::optional<Row>> in_parallel(std::size_t n, int jobs, Log& log, const char* what,
                                            const Work& work, const Name& name) {
  const Stopwatch watch;
  std::vector<std::optional<Row>> rows(n);
  std::size_t done = 0;
  std::atomic<std::size_t> next{0};
  std::exception_ptr failed;
  std::mutex mutex;
  const auto loop = [&] {
    for (std::size_t k = next++; k < n; k = next++) {
      try {
        std::optional<Row> row = work(k);
        const std::lock_guard lock(mutex);
        if (!row) {
          next = n;
          return;
        }
        log.progress(fmt::format("{} of {} {}, {}{}", ++done, n, what,
                                 duration_text(watch.seconds()), name(*row)));
        rows[k] = std::move(row);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failed) failed = std::current_exception();
        next = n;
      }
    }
  };
  std::vector<std::thread> threads;
  try {
    for (int j = 1; j < jobs; ++j) threads.emplace_back(loop);
  } catch (const std::system_error&) {  // no more threads available: continue with those there are
  }
  loop();
  for (std::thread& t : threads) t.join();
  if (failed) std::rethrow_exception(failed);
  return rows;
}

}  // namespace pbf::app_module
