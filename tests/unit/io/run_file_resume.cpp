#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "lib/base/error.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

RunInfo info_with_gauges() {
  RunInfo info = changing_info();
  info.columns = {{"level", "H", "", "m", "x = 0.5 m", Join::now},
                  {"velocity", "U", "", "m/s", "(1, 2, 3) m", Join::now, 3},
                  {"flow", "Q", "", "kg/s", "(1, 2, 3) m", Join::mean},
                  {"flow", "Q", "total", "kg", "(1, 2, 3) m", Join::total}};
  return info;
}
GaugeRow gauge_row(std::int64_t k) {
  const double x = double(k);
  return {10 * k, 0.1 * x, {x, 1 + x, 2 + x, 3 + x, 4 + x, 5 + x}};
}

/// Writes frames first .. last-1, two rows of the log and a reading of the gauges for each.
void write(RunWriter& writer, std::int64_t first, std::int64_t last) {
  for (std::int64_t k = first; k < last; ++k) {
    writer.log(sample_row(2 * k));
    writer.log(sample_row(2 * k + 1));
    writer.gauges(gauge_row(k));
    writer.write(changing_sample(k));
  }
}

void check_whole(const std::string& path, std::int64_t frames) {
  const RunReader reader(path);
  REQUIRE(reader.status() == "finished");
  REQUIRE(reader.frames() == frames);
  for (std::int64_t k = 0; k < frames; ++k) REQUIRE(same(reader.frame(k), changing_sample(k)));
  for (const char* name : {"update", "compression_mean", "stage/lambda"})
    REQUIRE(reader.log_column(name).size() == static_cast<std::size_t>(2 * frames));
  for (std::int64_t row = 0; row < 2 * frames; ++row)
    REQUIRE(reader.log_column("update").at(static_cast<std::size_t>(row)) ==
            sample_row(row).measures.update);
  const auto n = static_cast<std::size_t>(frames);
  CHECK(reader.gauges().size() == 6);
  REQUIRE(reader.gauge("update").size() == n);
  REQUIRE(reader.gauge("U").size() == 3 * n);
  CHECK(reader.gauge("V").empty());
  for (std::size_t k = 0; k < n; ++k) {
    const GaugeRow row = gauge_row(std::int64_t(k));
    REQUIRE(reader.gauge("time")[k] == row.time);
    REQUIRE(reader.gauge("update")[k] == double(row.update));
    REQUIRE(reader.gauge("H")[k] == row.numbers[0]);
    for (std::size_t c = 0; c < 3; ++c) REQUIRE(reader.gauge("U")[3 * k + c] == row.numbers[1 + c]);
    REQUIRE(reader.gauge("Q")[k] == row.numbers[4]);
    REQUIRE(reader.gauge("total/Q")[k] == row.numbers[5]);
  }
}

}  // namespace

TEST_CASE("a file goes on from whatever any single write to the disk has left",
          "[slow][run_file][many_states]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf", replica = folder / "replica.h5",
                    again = folder / "again.h5";
  const bool gzip = GENERATE(false, true);
  constexpr std::int64_t frames = 6;
  std::vector<DiskOperation> operations;
  {
    WatchedDisk disk(path);
    RunWriter writer(path, info_with_gauges(), gzip);
    for (std::int64_t k = 0; k < frames; ++k) {
      write(writer, k, k + 1);
      while (writer.frames_written() <= k) std::this_thread::yield();
      disk.mark(k + 1);
    }
    writer.finish({"finished"});
    operations = disk.operations();
  }
  check_whole(path, frames);
  const int fd = ::open(replica.c_str(), O_RDWR | O_CREAT, 0600);
  REQUIRE(fd >= 0);
  std::int64_t sure = 0, states = 0;
  for (const DiskOperation& op : operations) {
    if (op.kind == DiskOperation::mark) sure = op.offset;
    if (op.kind == DiskOperation::write)
      REQUIRE(::pwrite(fd, op.bytes.data(), op.bytes.size(), op.offset) ==
              static_cast<ssize_t>(op.bytes.size()));
    if (op.kind == DiskOperation::resize) REQUIRE(::ftruncate(fd, op.offset) == 0);
    if (sure < 1 || ++states % 5 != 0) continue;
    std::filesystem::copy_file(replica, again, std::filesystem::copy_options::overwrite_existing);
    std::int64_t kept = 0;
    {
      const RunReader before(again);
      kept = std::min<std::int64_t>(before.frames(),
                                    std::int64_t(before.log_column("update").size()) / 2);
      kept = std::min<std::int64_t>(kept, std::int64_t(before.gauge("update").size()));
      REQUIRE(kept >= sure);
    }
    INFO("state " << states << ", " << kept << " frames kept");
    RunWriter writer(again, info_with_gauges(), gzip, kept, {2 * kept, kept});
    write(writer, kept, frames);
    writer.finish({"finished"});
    check_whole(again, frames);
  }
  ::close(fd);
  REQUIRE(states > 100);
}

TEST_CASE("frames and rows that a resumed run does again are dropped, and sessions are told",
          "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  {
    RunWriter writer(path, info_with_gauges(), false);
    write(writer, 0, 5);
    writer.sync();
    CHECK(writer.frames_written() == 5);
    writer.finish({"stopped", "SIGTERM", 50});
  }
  {
    RunInfo info = info_with_gauges();
    info.first_update = 20;
    info.host = "node2";
    RunWriter writer(path, info, false, 2, {4, 2});
    CHECK(RunReader(path).frames() == 2);
    CHECK(RunReader(path).status() == "running");
    CHECK(RunReader(path).sessions().at(1).ended.empty());
    write(writer, 2, 8);
    writer.finish({"finished", "", 80});
  }
  check_whole(path, 8);
  const auto sessions = RunReader(path).sessions();
  REQUIRE(sessions.size() == 2);
  CHECK(sessions[0].reason == "SIGTERM");
  CHECK(sessions[0].last_update == 50);
  CHECK(sessions[1].reason == "finished");
  CHECK(sessions[1].first_update == 20);
  CHECK(sessions[1].last_update == 80);
  CHECK(sessions[1].host == "node2");
  CHECK(sessions[1].device == "cpu float, a processor");
  CHECK(sessions[1].program == "0.1.0 (0123abc)");
  // So many are not there.
  CHECK_THROWS_AS(RunWriter(path, info_with_gauges(), false, 9, {4, 2}), Error);
  CHECK_THROWS_AS(RunWriter(path, info_with_gauges(), false, 8, {16, 9}), Error);
  check_whole(path, 8);
}
