#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "lib/base/error.h"
#include "lib/io/h5.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"
#include "tests/support/split_frame.h"

using namespace pbf;
using namespace pbf::test;

namespace {

/// Steps/Values has to be no longer than NSteps: VTK's reader relies on it.
bool values_within_steps(const std::string& path) {
  const h5::Lock lock;
  const h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, h5::file_access()));
  const h5::Group steps(H5Gopen2(file, "VTKHDF/Steps", H5P_DEFAULT));
  return static_cast<std::int64_t>(h5::read_all<double>(steps, "Values").size()) <=
         h5::read_number<std::int64_t>(steps, "NSteps");
}

/// A copy of the file, changed operation by operation.
class Replica {
 public:
  explicit Replica(std::string path)
      : path_(std::move(path)), fd_(::open(path_.c_str(), O_RDWR | O_CREAT, 0600)) {}
  ~Replica() { ::close(fd_); }
  void apply(const DiskOperation& op, std::size_t size) {
    if (op.kind == DiskOperation::write)
      REQUIRE(::pwrite(fd_, op.bytes.data(), size, op.offset) == static_cast<ssize_t>(size));
    if (op.kind == DiskOperation::resize) REQUIRE(::ftruncate(fd_, op.offset) == 0);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int fd_;
};

}  // namespace

TEST_CASE("after every single write to the disk all frames reported so far are readable",
          "[slow][run_file][many_states]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const bool gzip = GENERATE(false, true), split = GENERATE(false, true);
  const auto operations = operations_of_a_run(path, 50, gzip, split);
  REQUIRE(operations.size() > 1000);
  Replica replica(folder / "replica.h5");
  std::int64_t sure = -1, states = 0;
  for (const DiskOperation& op : operations) {
    if (op.kind == DiskOperation::mark) {
      sure = op.offset;
      continue;
    }
    // A write cut in the middle, then whole: a signal may end a long one at a page.
    for (const std::size_t part : {op.bytes.size() / 2 & ~std::size_t{4095}, op.bytes.size()}) {
      if (part == 0 && op.kind == DiskOperation::write) continue;
      replica.apply(op, part);
      if (sure < 1) continue;  // nothing reported yet: the file may be anything
      ++states;
      INFO("state " << states << ", write at " << op.offset << ", " << sure << " frames reported");
      const RunReader reader(replica.path());
      REQUIRE(reader.frames() >= sure);
      REQUIRE(values_within_steps(replica.path()));
      for (const std::int64_t k : {std::int64_t{0}, sure / 2, sure - 1})
        REQUIRE(same(reader.frame(k), split ? split_sample(k) : changing_sample(k)));
    }
  }
  REQUIRE(states > 1000);
}

TEST_CASE("kill -9 at any moment leaves every reported frame", "[run_file][many_states]") {
  const TemporaryFolder folder;
  for (int trial = 0; trial < 12; ++trial) {
    const std::string path = (folder.path / ("run" + std::to_string(trial) + ".h5")).string();
    int channel[2];
    REQUIRE(::pipe(channel) == 0);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {  // reports every frame it may count on, until it is killed
      RunWriter writer(path, changing_info(), false);
      std::int64_t reported = 0;
      for (std::int64_t k = 0;; ++k) {
        writer.log(sample_row(k));
        writer.write(changing_sample(k));
        for (const std::int64_t sure = writer.frames_written(); reported < sure; ++reported)
          if (::write(channel[1], "f", 1) != 1) ::_exit(1);
      }
    }
    ::close(channel[1]);
    std::int64_t reported = 0;
    char byte;
    while (reported < 3 * trial && ::read(channel[0], &byte, 1) == 1) ++reported;
    std::this_thread::sleep_for(std::chrono::microseconds(377 * trial));
    REQUIRE(::kill(child, SIGKILL) == 0);
    while (::read(channel[0], &byte, 1) == 1) ++reported;
    ::close(channel[0]);
    int result = 0;
    REQUIRE(::waitpid(child, &result, 0) == child);
    REQUIRE(WIFSIGNALED(result));
    if (reported == 0) continue;
    const RunReader reader(path);
    INFO("trial " << trial << ", " << reported << " frames reported");
    CHECK(reader.status() == "running");
    REQUIRE(reader.frames() >= reported);
    for (std::int64_t k = 0; k < reader.frames(); ++k)
      REQUIRE(same(reader.frame(k), changing_sample(k)));
  }
}
