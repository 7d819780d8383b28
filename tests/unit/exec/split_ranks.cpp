// Rows that stay on their ranks: frames, states and displacements without all of them in one place.
#include <atomic>
#include <fstream>
#include <iterator>

#include "lib/exec/ranks/held_frame.h"
#include "lib/exec/ranks/id_ranges.h"
#include "tests/support/folder.h"
#include "tests/support/rank_runs.h"

namespace pbf::split_ranks_test {

using namespace test;

namespace {

RankScene a_scene(std::vector<std::string> more = {}) {
  more.push_back("fluid.spacing=0.04");
  return RankScene("configs/minimal", more);
}
template <class F>
void on_rank_0(const RankScene& m, int ranks, const F& f) {
  run_thread_ranks(ranks, [&](Communicator& c) {
    RankedSolver s(c, m.scene, m.plan, m.part(c));
    c.rank() == 0 ? f(s) : s.serve();
  });
}

}  // namespace

TEST_CASE("rows go to the rank of the range of their ids, from wherever they were") {
  constexpr int n = 9000;
  for (const int ranks : {1, 2, 3, 5}) {
    CAPTURE(ranks);
    const IdRanges ranges(n, ranks);
    CHECK(ranges.first(0) == 0);
    CHECK(ranges.first(ranks) == n);
    std::atomic<int> wrong = 0;  // threads may not use the macros of tests
    run_thread_ranks(ranks, [&](Communicator& c) {
      std::vector<std::int64_t> ids;
      std::vector<std::array<std::int32_t, 3>> rows;
      for (int i = 0; i < n; ++i)
        if (i * 7919 % 11 % ranks == c.rank()) ids.push_back(i), rows.push_back({i, 3 * i + 1, -i});
      ToRanges to(c, ranges, ids);
      const std::vector<std::byte> mine = to.move(std::as_bytes(std::span(rows)), 12);
      const std::int64_t first = ranges.first(c.rank());
      wrong += std::int64_t(mine.size()) != 12 * (ranges.first(c.rank() + 1) - first);
      bool right = true;
      for (std::size_t k = 0; k < mine.size() / 12; ++k) {
        std::int32_t row[3];
        std::memcpy(row, mine.data() + 12 * k, sizeof row);
        const int id = int(first) + int(k);
        right = right && row[0] == id && row[1] == 3 * id + 1 && row[2] == -id;
      }
      wrong += !right;
    });
    CHECK(wrong == 0);
  }
}

TEST_CASE("a particle that is on no rank, or on two, is an error and no wrong row") {
  for (const bool twice : {false, true})
    CHECK_THROWS_WITH(run_thread_ranks(2,
                                       [&](Communicator& c) {
                                         std::vector<std::int64_t> ids;
                                         for (int i = 0; i < 4000; ++i)
                                           if (i % 2 == c.rank() || (twice && i == 7))
                                             ids.push_back(!twice && i == 7 ? 9 : i);
                                         ToRanges(c, IdRanges(4000, 2), ids);
                                       }),
                      Catch::Contains("not every particle is on one of the ranks"));
}

TEST_CASE("ranks hold a frame, and write it where they are told: its bytes are those of one rank") {
  const RankScene m = a_scene();
  const TemporaryFolder folder;
  const auto one = make_solver(m.scene, m.plan, m.particles);
  one->step(20);
  const Snapshot whole = one->download({"velocity", "density"}, ScalarType::f32).get();
  const std::int64_t n = m.plan.particles, chunk = 700, chunks = (n + chunk - 1) / chunk;
  for (const int ranks : {2, 4}) {
    CAPTURE(ranks);
    const std::string path = folder / ("f" + std::to_string(ranks)).c_str();
    std::ofstream(path) << "";
    on_rank_0(m, ranks, [&](RankedSolver& s) {
      s.step(20);
      const Snapshot head = s.hold({"velocity", "density"}, ScalarType::f32);
      CHECK(std::int64_t(head.count) == n);
      CHECK(head.update == 20);
      REQUIRE(head.fields.size() == whole.fields.size());
      FramePlaces places{chunk, {}};
      std::uint64_t end = 64;
      for (std::size_t k = 0; k + 1 < head.fields.size(); ++k) {
        CHECK(head.fields[k].bytes.empty());
        std::vector<std::byte> all;
        s.held(k, 999, [&](std::int64_t first, FieldArray&& rows) {
          const std::size_t row = std::size_t(rows.components) * 4;
          CHECK(first * std::int64_t(row) == std::int64_t(all.size()));
          CHECK(rows.bytes.size() <= 999 * row);
          all.insert(all.end(), rows.bytes.begin(), rows.bytes.end());
        });
        CHECK(all == whole.fields[k].bytes);
        auto& at = places.chunks.emplace_back(std::size_t(chunks));
        for (auto c = at.rbegin(); c != at.rend(); ++c)  // the last chunk first
          *c = end, end += std::uint64_t(chunk) * std::uint64_t(head.fields[k].components) * 4;
      }
      CHECK(!s.share_file(path, inode_of(path) + 1));  // another file
      CHECK(s.share_file(path, inode_of(path)));
      s.write_held(places);
      s.step(1);  // goes on meanwhile
      CHECK(s.written(true));
      std::ifstream file(path, std::ios::binary);
      const std::string text(std::istreambuf_iterator<char>(file), {});
      for (std::size_t k = 0; k + 1 < whole.fields.size(); ++k) {
        const FieldArray& f = whole.fields[k];
        const std::size_t row = std::size_t(f.components) * 4;
        std::size_t wrong = 0;
        for (std::int64_t i = 0; i < n; ++i)
          wrong += std::memcmp(text.data() + places.chunks[k][std::size_t(i / chunk)] +
                                   std::size_t(i % chunk) * row,
                               f.bytes.data() + std::size_t(i) * row, row) != 0;
        CHECK(wrong == 0);
      }
    });
  }
}

TEST_CASE("a rank that cannot write its part of a frame ends all with its reason") {
  const RankScene m = a_scene();
  CHECK_THROWS_WITH(on_rank_0(m, 3,
                              [&](RankedSolver& s) {
                                s.hold({}, ScalarType::f32);
                                REQUIRE(s.share_file("/dev/full", inode_of("/dev/full")));
                                s.write_held({m.plan.particles, {{0}}});
                                s.written(true);
                              }),
                    Catch::Contains("No space left on device; the frames before it are kept"));
}

TEST_CASE("a state in pieces is the state, and a solver of other ranks takes it in pieces",
          "[slow]") {
  for (const std::vector<std::string>& set : std::vector<std::vector<std::string>>{
           {"precision=double", "domain.loads=true"}, {"solver.kernels=paper"}}) {
    CAPTURE(set);
    const RankScene m = a_scene(set);
    const auto one = make_solver(m.scene, m.plan, m.particles);
    one->step(30);
    const SolverState whole = one->state();
    one->step(10);
    const SolverState later = one->state();
    SolverState head;
    std::vector<SolverState> pieces;
    on_rank_0(m, 3, [&](RankedSolver& s) {
      s.step(30);
      s.state_in_pieces(StateOf::present, 1000,
                        {[&](SolverState&& h) { head = std::move(h); },
                         [&](std::int64_t first, SolverState&& rows) {
                           CHECK(first == 1000 * std::int64_t(pieces.size()));
                           CHECK(rows.id.size() <= 1000);
                           pieces.push_back(std::move(rows));
                         }});
    });
    CHECK(head.position.empty());
    SolverState all = head;
    for (const SolverState& p : pieces) append(p, all);
    CHECK(all.position == whole.position);
    CHECK(all.velocity == whole.velocity);
    CHECK(all.id == whole.id);
    CHECK(all.updates == 30);
    std::vector<int> asked;
    on_rank_0(m, 2, [&](RankedSolver& s) {
      s.set_state_in_pieces({head, m.plan.particles, [&](std::int64_t first, std::int64_t n) {
                               asked.push_back(int(n));
                               std::vector<int> rows(static_cast<std::size_t>(n));
                               std::iota(rows.begin(), rows.end(), int(first));
                               return picked(all, rows, m.plan);
                             }});
      s.step(10);
      const SolverState now = s.state(StateOf::present);
      CHECK(now.position == later.position);
      CHECK(now.velocity == later.velocity);
    });
    for (const int n : asked) CHECK(n <= kPieceRows);
  }
}

TEST_CASE("displacements on several ranks have the bits of those on one") {
  const RankScene m = a_scene();
  const auto one = make_solver(m.scene, m.plan, m.particles);
  std::vector<Moves> expected;
  std::vector<double> before = one->state(StateOf::positions).position;
  for (int k = 0; k < 3; ++k) {
    one->step(2, {.without_time = 1.0});
    std::vector<double> now = one->state(StateOf::positions).position;
    double squares = 0, farthest = 0;
    for (std::size_t i = 0; i < now.size(); i += 3) {
      double squared = 0;
      for (std::size_t a = i; a < i + 3; ++a)
        squared += (now[a] - before[a]) * (now[a] - before[a]);
      squares += squared;
      farthest = std::max(farthest, squared);
    }
    expected.push_back({});
    expected.back().squares = squares, expected.back().farthest = std::sqrt(farthest);
    before = std::move(now);
  }
  REQUIRE(expected[0].squares > 0);
  for (const int ranks : {2, 5})
    on_rank_0(m, ranks, [&](RankedSolver& s) {
      CHECK(s.moves().squares == 0);
      for (const Moves& e : expected) {
        s.step(2, {.without_time = 1.0});
        const Moves now = s.moves();
        CHECK(now.squares == e.squares);
        CHECK(now.farthest == e.farthest);
      }
    });
}

TEST_CASE("ranks that go back to the state that they kept go on to the bits of one") {
  const RankScene m = a_scene({"domain.loads=true"});
  const auto course = [](Solver& s, bool split) {
    s.step(10);
    s.keep();
    s.step(80);  // rows change ranks, and cuts move
    split ? s.split()->go_back() : s.set_state(s.state(StateOf::kept));
    CHECK(s.updates() == 10);
    s.step(20);
    return look(s);
  };
  const Seen one = course(*make_solver(m.scene, m.plan, m.particles), false);
  on_rank_0(m, 3, [&](RankedSolver& s) { check_same(one, course(s, true), m.scene); });
}

}  // namespace pbf::split_ranks_test
