// Updates that are run, recorded and replayed in parts are those of a loop, with the passes between
// them where they belong.
#include "lib/solver/batch.h"

#include <map>
#include <random>
#include <string>
#include <utility>

#include "tests/support/catch.h"

namespace pbf::batch_test {
namespace {

/// Notes what happens: "u" for an update, "b" for the passes between.
struct Stepping {
  std::string seen;
  int placement = 0, moves = 0;
  int capacity() const { return 1; }
  void step(int n) { seen += std::string(std::size_t(n), 'u'); }
  void between() { seen += 'b'; }
  std::pair<int, int> launch() const { return {placement, 7}; }
  void moved() { ++moves; }
};

std::string expected(std::int64_t at, std::int64_t every, int updates) {
  std::string out;
  for (std::int64_t k = at + 1; k <= at + updates; ++k) {
    out += 'u';
    if (every != 0 && k % every == 0) out += 'b';
  }
  return out;
}

}  // namespace

TEST_CASE("a batch runs what comes between updates behind every k-th since the start") {
  for (const std::int64_t every : {0, 1, 2, 3, 4, 16, 1 << 20})
    for (const std::int64_t at : {0, 1, 3, 4, 15, 16, (1 << 20) - 1})
      for (const int updates : {1, 2, 3, 4, 17, 64}) {
        Stepping s;
        Batch<Stepping> batch(s, at, every);
        batch.step(updates);
        CAPTURE(every, at, updates);
        CHECK(s.seen == expected(at, every, updates));
      }
}

TEST_CASE("a recording replayed wherever its key says so is what a loop does") {
  std::mt19937 random(5);
  for (const std::int64_t every : {0, 1, 2, 3, 4, 5, 8, 16, 64, 100}) {
    std::map<std::array<int, 4>, std::string> recordings;
    std::int64_t at = 0;
    for (int round = 0; round < 200; ++round) {
      const int updates = 1 + int(random() % 70);
      Stepping s;
      s.placement = int(random() % 2);
      Batch<Stepping> batch(s, at, every);
      int replays = 0;
      for (int left = updates; left > 0;) {
        int n = 1;
        for (const int size : {64, 8, 4, 2})
          if (n == 1 && size <= left && batch.has_form(size)) n = size;
        left -= n;
        if (n == 1) {
          batch.step(1);
          continue;
        }
        const auto [place, is_new] = recordings.try_emplace(batch.recording(n));
        if (is_new) {
          const std::string before = std::exchange(s.seen, "");
          Batch<Stepping> recorded = batch;
          recorded.step(n);
          place->second = std::exchange(s.seen, before);
        }
        s.seen += place->second;
        batch.replayed(n);
        ++replays;
      }
      CAPTURE(every, at, updates);
      REQUIRE(s.seen == expected(at, every, updates));
      CHECK(s.moves == replays);
      at += updates;
    }
    CAPTURE(every);
    CHECK(recordings.size() <= 2 * 4 * 3);  // placements, sizes, forms
  }
}

TEST_CASE("updates of which a part lies behind the next passes between have no form") {
  Stepping s;
  const Batch<Stepping> batch(s, 2, 8);
  CHECK(batch.has_form(4));
  CHECK(!batch.has_form(8));
  CHECK(Batch<Stepping>(s, 8, 8).has_form(64));
  CHECK(Batch<Stepping>(s, 3, 0).has_form(64));
  CHECK(batch.recording(4) != Batch<Stepping>(s, 4, 8).recording(4));
  CHECK(batch.recording(4) == Batch<Stepping>(s, 1, 8).recording(4));
}

}  // namespace pbf::batch_test
