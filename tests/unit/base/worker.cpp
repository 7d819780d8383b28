// A thread with a queue: what it does when idle, and that nobody waits for ever when that fails.
#include "lib/base/worker.h"

#include <atomic>
#include <chrono>
#include <stdexcept>

#include "tests/support/catch.h"

namespace pbf::worker_test {
namespace {

using namespace std::chrono_literals;

/// Waits for at most ten seconds.
template <class Condition>
bool soon(const Condition& there) {
  for (int k = 0; k < 1000 && !there(); ++k) std::this_thread::sleep_for(10ms);
  return there();
}

}  // namespace

TEST_CASE("a worker acts once when no job has come for a while, and again after the next job") {
  std::atomic<int> idle = 0, done = 0;
  Worker worker(2, {0.01, [&] { ++idle; }});
  std::this_thread::sleep_for(50ms);
  CHECK(idle == 0);  // nothing was done yet
  worker.push([&] { ++done; }, false);
  CHECK(soon([&] { return idle == 1; }));
  std::this_thread::sleep_for(50ms);
  CHECK(idle == 1);
  worker.push([&] { ++done; }, true);
  CHECK(soon([&] { return idle == 2; }));
  CHECK(done == 2);
}

TEST_CASE("when what a worker does while idle fails, whoever waits for a job is told", "[slow]") {
  std::atomic<bool> failing = false;
  Worker worker(1, {0.01, [&] {
                      failing = true;
                      std::this_thread::sleep_for(200ms);
                      throw std::runtime_error("disk full");
                    }});
  REQUIRE(worker.push([] {}, false));
  REQUIRE(soon([&] { return failing.load(); }));
  worker.push([] {}, true);  // while it fails: dropped
  worker.wait();
  CHECK(soon([&] { return worker.failure() != nullptr; }));
  CHECK_FALSE(worker.push([] {}, true));
}

}  // namespace pbf::worker_test
