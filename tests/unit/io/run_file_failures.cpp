#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/io/h5.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

/// Runs `action`, which has to throw an Error with this code whose text holds all the words.
template <class Action>
std::string error_of(ExitCode code, const std::vector<std::string>& words, Action action) {
  try {
    action();
  } catch (const Error& e) {
    const std::string text = e.what();
    INFO(text);
    CHECK(e.code() == code);
    for (const auto& w : words) {
      INFO("expected: " << w);
      CHECK(text.find(w) != std::string::npos);
    }
    return text;
  }
  FAIL("no error");
  return {};
}

std::string good_file(const TemporaryFolder& folder, std::int64_t frames) {
  const std::string path = folder / "good.h5";
  RunWriter writer(path, sample_info(20), false);
  for (std::int64_t k = 0; k < frames; ++k) {
    writer.log(sample_row(k));
    writer.write(sample(k, 20));
  }
  writer.finish({"finished"});
  return path;
}

/// Writes until the disk is full; the error comes out of one of the calls.
void write_until_full(const std::string& path, bool gzip, std::size_t count) {
  RunWriter writer(path, sample_info(static_cast<std::int64_t>(count)), gzip);
  for (std::int64_t k = 0; k < 1000; ++k) {
    writer.log(sample_row(k));
    writer.write(sample(k, count));
    if (k == 1) writer.sync();  // two frames are safe
  }
  writer.finish({"finished"});
}

}  // namespace

TEST_CASE("a run file is never overwritten", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = good_file(folder, 2);
  error_of(ExitCode::io, {path, "cannot create", "File exists"},
           [&] { RunWriter(path, sample_info(20), false); });
  CHECK(RunReader(path).frames() == 2);
}

TEST_CASE("a place that cannot be written to is named with the reason", "[run_file]") {
  const TemporaryFolder folder;
  const std::string file = folder / "file";
  std::ofstream(file) << "in the way";
  error_of(ExitCode::io, {file + "/run.vtkhdf", "Not a directory"},
           [&] { RunWriter(file + "/run.vtkhdf", sample_info(20), false); });
  error_of(ExitCode::io, {"missing/run.vtkhdf", "No such file or directory"},
           [&] { RunWriter(folder / "missing/run.vtkhdf", sample_info(20), false); });
}

TEST_CASE("a full disk ends the run with the frame, the reason and what is kept",
          "[slow][run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const bool gzip = GENERATE(false, true);
  const std::size_t count = GENERATE(std::size_t{500}, std::size_t{60000});
  RunWriter whole(path, sample_info(static_cast<std::int64_t>(count)), gzip);
  std::int64_t start = 0;  // bytes with one frame
  for (std::int64_t k = 0; k < 6; ++k) {
    whole.log(sample_row(k));
    whole.write(sample(k, count));
    while (whole.frames_written() == 0) std::this_thread::yield();
    if (k == 0) start = whole.bytes_written();
  }
  whole.finish({"finished"});
  const std::int64_t frames = whole.bytes_written() - start;
  // Full at every kind of moment: in the data, the index, the tables, the log.
  for (int step = 0; step < 12; ++step) {
    std::filesystem::remove(path);
    const std::int64_t capacity = start + frames * step / 13 + 171 * step;
    INFO("capacity " << capacity);
    const WatchedDisk disk(path, capacity, false);
    const auto text = error_of(ExitCode::io, {path, "No space left on device"},
                               [&] { write_until_full(path, gzip, count); });
    REQUIRE(disk.refused() > 0);
    const RunReader reader(path);
    const std::int64_t kept = reader.frames();
    INFO(text);
    REQUIRE(kept >= 1);
    REQUIRE(text.find("frame") != std::string::npos);
    if (kept > 1)
      CHECK(text.find("frames 0.." + std::to_string(kept - 1) + " are kept") != std::string::npos);
    for (std::int64_t k = 0; k < kept; ++k) REQUIRE(same(reader.frame(k), sample(k, count)));
  }
}

TEST_CASE("a disk that is full from the start is an error of creation", "[run_file]") {
  const TemporaryFolder folder;
  for (const std::int64_t capacity : {0, 100, 3000, 60000}) {
    const std::string path = (folder.path / std::to_string(capacity)).string();
    const WatchedDisk disk(path, capacity, false);
    error_of(ExitCode::io, {path, "No space left on device"},
             [&] { RunWriter(path, sample_info(20), false).finish({"finished"}); });
  }
}

TEST_CASE("after a failure every call says the same and nothing hangs", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const WatchedDisk disk(path, 1000000, false);
  RunWriter writer(path, sample_info(100000), false);
  const auto again = [&](auto call) { return error_of(ExitCode::io, {"frame 0"}, call); };
  again([&] {
    for (;;) writer.write(sample(0, 100000));
  });
  again([&] { writer.write(sample(0, 100000)); });
  again([&] { writer.log(sample_row(0)); });
  again([&] { writer.finish({"finished"}); });
  again([&] { writer.finish({"finished"}); });
  CHECK(writer.frames_written() == 0);
}

TEST_CASE("a process whose files may not grow ends cleanly", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::alarm(60);  // a hang ends as a signal
    const rlimit limit{4000000, 4000000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int result = 1;
    try {
      write_until_full(path, false, 20000);
    } catch (const Error& e) {
      result = std::string(e.what()).find("File too large") != std::string::npos ? 5 : 2;
    }
    ::exit(result);  // with all that runs at exit, HDF5's part included
  }
  int result = 0;
  REQUIRE(::waitpid(child, &result, 0) == child);
  REQUIRE(WIFEXITED(result));
  CHECK(WEXITSTATUS(result) == 5);
  CHECK(RunReader(path).frames() >= 2);
}

TEST_CASE("a snapshot that does not fit is a defect, not a file error", "[run_file]") {
  const TemporaryFolder folder;
  int number = 0;
  const auto refused = [&](Snapshot bad, const std::string& word) {
    const std::string path = (folder.path / std::to_string(number++)).string();
    RunWriter writer(path, sample_info(20), false);
    writer.write(sample(0, 20));
    writer.write(std::move(bad));
    error_of(ExitCode::internal, {word}, [&] { writer.finish({"finished"}); });
    CHECK(RunReader(path).frames() == 1);
  };
  Snapshot s = sample(1, 20);
  s.fields.erase(s.fields.begin());
  refused(s, "position");
  s = sample(1, 20);
  s.fields[1].bytes.pop_back();
  refused(s, "velocity");
  s = sample(1, 20);
  s.fields.erase(s.fields.begin() + 1);
  refused(s, "density");
  refused(sample(1, 20, ScalarType::f64), "position");
  s = sample(1, 20);
  std::swap(s.fields[3].as<std::int32_t>()[3], s.fields[3].as<std::int32_t>()[4]);
  refused(s, "id order");
}

TEST_CASE("nothing can be written after the end", "[run_file]") {
  const TemporaryFolder folder;
  RunWriter writer(folder / "run.vtkhdf", sample_info(20), false);
  writer.finish({"finished"});
  writer.finish({"finished"});  // says nothing new
  error_of(ExitCode::internal, {"after its end"}, [&] { writer.write(sample(0, 20)); });
}

TEST_CASE("a frame that is not there is refused with what is there", "[run_file]") {
  const TemporaryFolder folder;
  const RunReader reader(good_file(folder, 3));
  error_of(ExitCode::bad_input, {"no frame 3", "0..2"}, [&] { reader.frame(3); });
  error_of(ExitCode::bad_input, {"no frame -1"}, [&] { reader.frame(-1); });
}

TEST_CASE("files that are no run files are named with the reason", "[run_file]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& path, const std::string& word) {
    error_of(ExitCode::io, {path, word}, [&] { const RunReader reader(path); });
  };
  refused(folder / "missing.h5", "No such file");
  refused(folder.path.string(), "");
  const std::string empty = folder / "empty.h5", text = folder / "text.h5";
  std::ofstream(empty).close();
  refused(empty, "");
  std::ofstream(text) << std::string(5000, 'x');
  refused(text, "");
  const auto hdf5 = [&](const char* name, auto fill) {
    const h5::Lock lock;
    const std::string path = folder / name;
    const h5::File file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, h5::file_access()));
    fill(file);
    return path;
  };
  refused(hdf5("foreign.h5", [](const h5::File&) {}), "not one that pbf wrote");
  refused(hdf5("other.h5",
               [](const h5::File& file) {
                 for (const char* g : {"pbf", "VTKHDF", "VTKHDF/Steps"})
                   h5::Group(H5Gcreate2(file, g, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
               }),
          "format_version");
  const std::string newer = good_file(folder, 1);
  {
    const h5::Lock lock;
    const h5::File file(H5Fopen(newer.c_str(), H5F_ACC_RDWR, h5::file_access()));
    const h5::Group pbf(H5Gopen2(file, "pbf", H5P_DEFAULT));
    const h5::Attribute version(H5Aopen(pbf, "format_version", H5P_DEFAULT));
    const int number = 7;
    h5::check(H5Awrite(version, H5T_NATIVE_INT, &number));
  }
  refused(newer, "format version 7; this program reads version 1");
}

TEST_CASE("a file cut off anywhere is refused or read, never a crash", "[slow][run_file]") {
  const TemporaryFolder folder;
  const std::string good = good_file(folder, 3), cut = folder / "cut.h5";
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(good));
  std::vector<std::int64_t> lengths = {0, 1, 7, 8, 9, 47, 48, 95, 96, 97, 511, 512, 2048, size - 1};
  for (int k = 1; k < 10; ++k) lengths.push_back(size * k / 10);
  for (const std::int64_t length : lengths) {
    std::filesystem::copy_file(good, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(length));
    INFO("length " << length);
    error_of(ExitCode::io, {cut}, [&] { RunReader(cut).frame(0); });
  }
}

TEST_CASE("trying a run file comes to an end while another thread reads files") {
  const TemporaryFolder folder;
  const std::string path = good_file(folder, 1);
  std::atomic<bool> end{false};
  std::thread other([&] {
    while (!end) note_input(path);
  });
  for (int k = 0; k < 100; ++k) CHECK_NOTHROW(try_run_file(path));
  end = true;
  other.join();
}
