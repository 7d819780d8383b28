// When frames are safe: at once, or together with others that come soon after.
#include <algorithm>
#include <chrono>
#include <thread>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

/// Waits for so many frames to be safe, at most so many seconds.
bool safe_within(const RunWriter& writer, std::int64_t frames, double seconds) {
  for (int k = 0; k < int(1000 * seconds) && writer.frames_written() < frames; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return writer.frames_written() >= frames;
}

std::int64_t barriers_of(std::int64_t frames, bool each) {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const WatchedDisk disk(path);
  RunWriter writer(path, sample_info(20), false);
  for (std::int64_t k = 0; k < frames; ++k) {
    writer.write(sample(k, 20));
    if (each) writer.sync();
  }
  writer.finish({"finished"});
  CHECK(RunReader(path).frames() == frames);
  const auto all = disk.operations();
  return std::ranges::count(all, DiskOperation::barrier, &DiskOperation::kind);
}

}  // namespace

TEST_CASE("a frame that comes soon after another is safe without a further call", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  RunWriter writer(path, sample_info(20), false);
  for (std::int64_t k = 0; k < 5; ++k) writer.write(sample(k, 20));
  CHECK(safe_within(writer, 5, 30));
  CHECK(RunReader(path).frames() == 5);
  SECTION("and while rows of the log come, but no frame") {
    writer.write(sample(5, 20));
    for (std::int64_t k = 0; k < 3000 && writer.frames_written() < 6; ++k) {
      writer.log(sample_row(k));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    CHECK(writer.frames_written() == 6);
  }
}

TEST_CASE("frames that come fast wait for the disk together", "[run_file]") {
  const std::int64_t frames = 40, together = barriers_of(frames, false),
                     single = barriers_of(frames, true);
  CHECK(single >= 3 * frames);
  CHECK(together < single / 2);
}

TEST_CASE("frames of several chunks of the tables of steps are all there", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const std::int64_t frames = 1100;  // two chunks and a part
  RunWriter writer(path, sample_info(3), false);
  for (std::int64_t k = 0; k < frames; ++k) writer.write(sample(k, 3));
  writer.finish({"finished"});
  const RunReader reader(path);
  REQUIRE(reader.frames() == frames);
  for (const std::int64_t k : {0, 511, 512, 513, 1023, 1024, 1099}) {
    CAPTURE(k);
    CHECK(same(reader.frame(k), sample(k, 3)));
    CHECK(reader.times()[std::size_t(k)] == sample(k, 3).time);
  }
}
