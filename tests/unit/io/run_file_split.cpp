// Frames whose rows several ranks write: the file is that of one process.
#include <sys/stat.h>

#include "lib/base/error.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"
#include "tests/support/same_run.h"
#include "tests/support/split_frame.h"

using namespace pbf;
using namespace pbf::test;

TEST_CASE("a file whose rows several ranks wrote has the bytes of one that a process wrote alone",
          "[run_file]") {
  const TemporaryFolder folder;
  const bool gzip = GENERATE(false, true);
  const ScalarType real = GENERATE(ScalarType::f32, ScalarType::f64);
  const std::string whole = folder / "whole.h5", split = folder / "split.h5";
  {
    RunWriter a(whole, sample_info(3000), gzip), b(split, sample_info(3000), gzip);
    for (std::int64_t k = 0; k < 4; ++k) {
      a.log(sample_row(k)), b.log(sample_row(k));
      a.write(sample(k, 3000, real));
      write_split(b, split, sample(k, 3000, real), 1 + int(k));
    }
    a.finish({"finished"}), b.finish({"finished"});
  }
  CHECK(run_difference(whole, split) == "");
  const RunReader reader(split);
  REQUIRE(reader.frames() == 4);
  for (std::int64_t k = 0; k < 4; ++k) CHECK(same(reader.frame(k), sample(k, 3000, real)));
}

TEST_CASE("rows that several ranks write lie in chunks if they are more than one may have",
          "[slow][run_file]") {
  constexpr std::int64_t n = (std::int64_t{1} << 22) + 1025;
  const TemporaryFolder folder;
  const std::string path = folder / "run.h5";
  RunWriter writer(path, sample_info(n), false);
  const Snapshot frame = sample(1, n);
  CHECK(writer.begin_frame(without_bytes(frame)).chunks.at(0).size() == 2);
  writer.commit_frame();  // of rows that nobody wrote
  write_split(writer, path, frame, 3);
  writer.finish({"finished"});
  CHECK(same(RunReader(path).frame(1), frame));
}

TEST_CASE("a frame that was begun and not ended is not there, and the file goes on without it",
          "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.h5", other = folder / "other.h5";
  {
    RunWriter writer(path, sample_info(100), false);
    write_split(writer, path, sample(0, 100), 2);
    writer.log(sample_row(0));
    writer.begin_frame(without_bytes(sample(1, 100)));
    writer.sync();  // the log may be stored before the frame
  }
  CHECK(RunReader(path).frames() == 1);
  {
    RunWriter writer(path, sample_info(100), false, 1, {1, 0});
    write_split(writer, path, sample(1, 100), 2);
    writer.finish({"finished"});
    RunWriter alone(other, sample_info(100), false);
    for (int k : {0, 1}) {
      alone.write(sample(k, 100));
      if (k == 0) alone.log(sample_row(0));
    }
    alone.finish({"finished"});
  }
  CHECK(run_difference(path, other) == "");
}

TEST_CASE("a disk that has no room for a frame of several ranks is told before they write it",
          "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.h5";
  WatchedDisk disk(path, 4 << 20);
  RunWriter writer(path, sample_info(5000), false);
  std::string told;
  try {
    for (std::int64_t k = 0; k < 100; ++k) write_split(writer, path, sample(k, 5000), 2);
  } catch (const Error& e) {
    told = e.what();
    CHECK(e.code() == ExitCode::io);
  }
  const std::int64_t kept = RunReader(path).frames();
  REQUIRE(kept > 1);
  CHECK(told == path + ": cannot write frame " + std::to_string(kept) +
                    ": No space left on device; frames 0.." + std::to_string(kept - 1) +
                    " are kept");
  for (std::int64_t k = 0; k < kept; ++k) CHECK(same(RunReader(path).frame(k), sample(k, 5000)));
}
