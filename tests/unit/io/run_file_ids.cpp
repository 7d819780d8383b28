// Run files of particles that appear and disappear: ids with gaps, other numbers in other frames.
#include <numeric>
#include <set>

#include "lib/base/error.h"
#include "lib/io/h5_read.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

using Ids = std::vector<std::int64_t>;

Ids up_to(std::int64_t n) {
  Ids ids(static_cast<std::size_t>(n));
  std::iota(ids.begin(), ids.end(), std::int64_t{0});
  return ids;
}

Snapshot frame_of(const std::vector<Ids>& all, std::int64_t k, ScalarType type) {
  const Ids& ids = all[static_cast<std::size_t>(k)];
  return with_ids(sample(k, ids.size()), ids, type);
}

void write(RunWriter& writer, const std::vector<Ids>& all, std::int64_t first, ScalarType type) {
  for (std::int64_t k = first; k < std::int64_t(all.size()); ++k)
    writer.write(frame_of(all, k, type));
  writer.finish({"finished"});
}

void check(const std::string& path, const std::vector<Ids>& all, ScalarType type) {
  const RunReader reader(path);
  REQUIRE(reader.frames() == std::int64_t(all.size()));
  for (std::int64_t k = 0; k < reader.frames(); ++k) {
    CAPTURE(k);
    REQUIRE(same(reader.frame(k), frame_of(all, k, type)));
    CHECK(ids_of(reader.frame(k)) == all[std::size_t(k)]);
    CHECK(reader.counts()[std::size_t(k)] == std::int64_t(all[std::size_t(k)].size()));
  }
}

/// Starts and ends, gaps, no particle at all, and more than there were; the last beyond 2^31 where
/// the type has it.
std::vector<Ids> lives(ScalarType type) {
  std::vector<Ids> all{up_to(20),          {3, 4, 7}, up_to(12), {},
                       {1, 5, 19, 20, 31}, up_to(25), {24},      {}};
  if (type == ScalarType::i64)
    all.push_back({0, 2147483646, 2147483647, 2147483648, (std::int64_t{1} << 62) + 1});
  return all;
}

std::vector<std::int64_t> table(const std::string& path, const std::string& name) {
  const h5::Reading file(path);
  return h5::read_all<std::int64_t>(file, "VTKHDF/" + name);
}

}  // namespace

TEST_CASE("each frame keeps its own ids: with gaps, none, and beyond 2^31", "[run_file]") {
  const ScalarType type = GENERATE(ScalarType::i32, ScalarType::i64);
  const bool gzip = GENERATE(false, true);
  const bool told = GENERATE(false, true);  // how many there will be at most
  std::vector<Ids> all = lives(type);
  if (GENERATE(false, true)) std::swap(all[0], all[4]);  // gaps from the start
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  RunInfo info = sample_info(std::int64_t(all[0].size()));
  if (told) info.capacity = 25;
  RunWriter writer(path, info, gzip);
  write(writer, all, 0, type);
  check(path, all, type);
  CHECK(RunReader(path).info().capacity == info.capacity);
}

TEST_CASE("a file is cut to any of its frames and goes on with other particles", "[run_file]") {
  const ScalarType type = ScalarType::i64;
  const bool told = GENERATE(false, true);
  const std::vector<Ids> all = lives(type);
  std::vector<Ids> others = all;
  for (Ids& ids : others) ids.push_back((ids.empty() ? 0 : ids.back()) + 2);
  RunInfo info = sample_info(20);
  if (told) info.capacity = 26;
  for (std::size_t kept = 1; kept <= all.size(); ++kept) {
    CAPTURE(kept);
    const TemporaryFolder folder;
    const std::string path = folder / "run.vtkhdf";
    {
      RunWriter writer(path, info, kept % 2 == 0);
      write(writer, all, 0, type);
    }
    std::vector<Ids> expected = others;
    std::copy_n(all.begin(), kept, expected.begin());
    {
      RunWriter writer(path, info, kept % 2 == 0, std::int64_t(kept), {});
      write(writer, expected, std::int64_t(kept), type);
    }
    check(path, expected, type);
  }
}

TEST_CASE("ids 0, 1, 2 ... are stored once, in 32 bits, and others once a frame", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const auto written = [&](const std::vector<Ids>& all, std::int64_t capacity) {
    std::filesystem::remove(path);
    RunInfo info = sample_info(4);
    info.capacity = capacity;
    RunWriter writer(path, info, false);
    write(writer, all, 0, ScalarType::i32);
    return table(path, "PointData/id");
  };
  CHECK(written({up_to(4), up_to(4), up_to(4)}, 0) == up_to(4));
  {
    const h5::Reading file(path);
    CHECK(H5Tget_size(h5::Type(H5Dget_type(h5::open_dataset(file, "VTKHDF/PointData/id")))) == 4);
  }
  CHECK(written({up_to(4), up_to(6), up_to(2)}, 6) == up_to(6));
  const Ids ids = written({up_to(4), {1, 3, 8}, up_to(5), {8, 9}}, 6);
  CHECK(table(path, "Steps/PointDataOffsets/id") == Ids{0, 6, 0, 12});
  CHECK(table(path, "Vertices/Connectivity") == up_to(6));
  REQUIRE(ids.size() == 14);
  CHECK(Ids(ids.begin(), ids.begin() + 9) == Ids{0, 1, 2, 3, 4, 5, 1, 3, 8});
  CHECK(Ids(ids.begin() + 12, ids.end()) == Ids{8, 9});
}

TEST_CASE("a frame whose ids are missing, do not ascend or change their type is refused",
          "[run_file]") {
  std::vector<Snapshot> wrong{with_ids(sample(1, 3), {0, 2, 2}), with_ids(sample(1, 3), {0, 2, 1}),
                              with_ids(sample(1, 3), {-1, 0, 1}),
                              with_ids(sample(1, 3), {0, 1, 2}, ScalarType::i64), sample(1, 3)};
  wrong.back().fields.pop_back();
  for (const Snapshot& s : wrong) {
    const TemporaryFolder folder;
    RunWriter writer(folder / "run.vtkhdf", sample_info(3), false);
    writer.write(sample(0, 3));
    writer.write(Snapshot(s));
    CHECK_THROWS_AS(writer.finish({"finished"}), Error);
    CHECK(RunReader(folder / "run.vtkhdf").frames() == 1);
  }
}
