// Rows that go to other ranks before a sort.
#include "lib/exec/ranks/row_routes.h"

#include <map>
#include <mutex>
#include <random>

#include "lib/exec/cpu/cpu_exec.h"
#include "lib/exec/ranks/thread_ranks.h"
#include "tests/support/catch.h"

namespace pbf::row_routes_test {
namespace {

constexpr int kLayers = 12, kBins = 5, kRanks = 3, kRoom = 4000;

/// First of a sort: the bin of a row is known.
struct KnownBin {
  const int* known;
  int* bin;
  void operator()(int i) const { bin[i] = known[i]; }
};

/// Particles are at home in the layers of a rank; `moved` says to which layer each has moved.
struct Particle {
  int id, home, now;
};
using Moved = std::function<int(int home, int id)>;
std::vector<Particle> particles(const Moved& moved) {
  std::vector<Particle> all;
  for (int id = 0; id < 40 * kLayers; ++id) {
    const int home = id % kLayers;
    all.push_back({id, home, std::clamp(moved(home, id), 0, kLayers - 1)});
  }
  return all;
}

/// One rank with rows of an id, a bin and values.
struct Rank {
  Communicator& ranks;
  Slabs slabs{std::vector<std::int64_t>(kLayers, 40), kRanks, 1};
  CpuExec exec{1};
  RowRoutes<CpuExec> routes{ranks};
  std::vector<int> id = std::vector<int>(kRoom), known = id, bin = id;
  std::vector<float> value = std::vector<float>(4 * kRoom);
  SortedRows rows{};

  explicit Rank(Communicator& c) : ranks(c) { exec.connect(c); }
  void add(int at, const Particle& p, int i) {
    id[std::size_t(i)] = at;
    known[std::size_t(i)] = p.now * kBins + p.id % kBins;
    for (int k = 0; k < 4; ++k) value[std::size_t(4 * i + k)] = float(p.id) + 0.25f * float(k);
  }
  /// Ghosts before and behind the particles that are at home here.
  void fill(const std::vector<Particle>& all, int capacity = kRoom) {
    const int me = ranks.rank();
    int n = 0;
    const auto put = [&](const auto& belongs) {
      for (const Particle& p : all)
        if (belongs(p.home)) add(p.id, p, n++);
      return n;
    };
    rows.own.first = put([&](int l) { return l == slabs.low(me) - 1; });
    rows.own.last = put([&](int l) { return slabs.low(me) <= l && l < slabs.high(me); });
    rows.all = put([&](int l) { return l == slabs.high(me); });
    rows.capacity = capacity;
    rows.fields.rows[0] = reinterpret_cast<std::uint32_t*>(id.data());
    rows.fields.rows[1] = reinterpret_cast<std::uint32_t*>(bin.data());
    rows.fields.rows[2] = reinterpret_cast<std::uint32_t*>(value.data());
    rows.fields.begin[1] = 1, rows.fields.begin[2] = 2, rows.fields.begin[3] = 6;
    rows.fields.fields = 3;
  }
  bool exchange(bool counted) {
    const auto select = [&] {
      const RowLists to = routes.lists(exec, slabs, kBins);
      exec.items(rows.own, SelectRowsPass<KnownBin>{{known.data(), bin.data()}, to});
      return to;
    };
    rows.all = counted ? routes.exchange_counted(exec, rows, bin.data(), select)
                       : routes.exchange(exec, rows, bin.data(), select);
    exec.ask(routes.counts());
    return !counted || routes.learn(exec.answer<5>());
  }
  /// The particles whose bins are in the slab or next to it, each once, with its values; false
  /// otherwise.
  bool has_exactly(const std::vector<Particle>& all) const {
    const int low = std::max(slabs.low(ranks.rank()) - 1, 0), high = slabs.high(ranks.rank());
    std::map<int, int> found;
    for (int i = 0; i < rows.all; ++i) {
      const int at = bin[std::size_t(i)];
      if (at < low * kBins || at >= (high + 1) * kBins) continue;
      ++found[id[std::size_t(i)]];
      for (int k = 0; k < 4; ++k)
        if (value[std::size_t(4 * i + k)] != float(id[std::size_t(i)]) + 0.25f * float(k))
          return false;
    }
    std::map<int, int> wanted;
    for (const Particle& p : all)
      if (low <= p.now && p.now <= high) ++wanted[p.id];
    return found == wanted;
  }
};

/// Runs work(rank) on all ranks; true if it is true on all of them.
bool on_all(const std::function<bool(Rank&)>& work) {
  std::mutex mutex;
  bool all = true;
  run_thread_ranks(kRanks, [&](Communicator& c) {
    Rank rank(c);
    const bool good = work(rank);
    const std::lock_guard lock(mutex);
    all = all && good;
  });
  return all;
}

int stays(int home, int) { return home; }
int a_step(int home, int id) { return home + (id / kLayers) % 3 - 1; }
int far(int home, int id) { return id == 1 ? kLayers - 1 - home : home; }

}  // namespace

TEST_CASE("before a sort every rank gets the particles of its layers and the adjacent ones, once") {
  for (const Moved& moved : {Moved(stays), Moved(a_step), Moved(far), Moved([](int, int id) {
                               return std::minstd_rand(unsigned(id + 1))() % kLayers;
                             })})
    CHECK(on_all([&](Rank& r) {
      const auto all = particles(moved);
      r.fill(all);
      return r.exchange(false) && r.has_exactly(all);
    }));
}

TEST_CASE("messages with room for more rows than the last ones bring the same rows") {
  CHECK(on_all([](Rank& r) {
    r.fill(particles(stays));
    r.exchange(false);
    bool good = true;
    for (const Moved& moved : {Moved(a_step), Moved(stays), Moved(a_step)}) {
      const auto all = particles(moved);
      r.fill(all);
      good = r.exchange(true) && r.has_exactly(all) && good;
    }
    return good;
  }));
}

TEST_CASE("a row that finds no room in a message, or goes beyond the adjacent ranks, is missed") {
  // 40 particles are in a layer, and messages have room for 301 to 391 rows after that.
  const auto rush = [](int home, int) { return home >= 4 && home < 8 ? 3 : home; };
  std::mutex mutex;
  std::map<int, bool> crowded, beyond, short_of;
  run_thread_ranks(kRanks, [&](Communicator& c) {
    Rank r(c);
    r.fill(particles(stays));
    r.exchange(false);
    auto many = particles(rush);
    for (int k = 1; k < 4; ++k)  // four times as many
      for (Particle p : particles(rush)) p.id += k * 480, many.push_back(p);
    r.fill(many);
    const bool all = r.exchange(true);
    Rank s(c);
    s.fill(particles(stays));
    s.exchange(false);
    s.fill(particles(far));
    const bool none_far = s.exchange(true);
    Rank t(c);
    t.fill(particles(stays));
    t.exchange(false);
    t.fill(particles(stays), c.rank() == 1 ? t.rows.own.last + 100 : kRoom);
    const bool fits = t.exchange(true);
    const std::lock_guard lock(mutex);
    crowded[c.rank()] = all, beyond[c.rank()] = none_far, short_of[c.rank()] = fits;
  });
  CHECK(crowded == std::map<int, bool>{{0, false}, {1, false}, {2, true}});
  CHECK_FALSE(beyond[0]);  // particle 1 goes from layer 1 to layer 10
  CHECK_FALSE(short_of[1]);
}

TEST_CASE("more rows than a rank has memory for end in an error") {
  CHECK_THROWS_AS(on_all([](Rank& r) {
                    r.fill(particles(a_step), 200);
                    return r.exchange(false);
                  }),
                  Error);
}

}  // namespace pbf::row_routes_test
