// A power cut: what the process wrote since the last barrier is on the disk in part, page by page,
// in whatever order the system chose.
#include <algorithm>
#include <fstream>
#include <map>
#include <random>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"
#include "tests/support/split_frame.h"

using namespace pbf;
using namespace pbf::test;

namespace {

constexpr std::int64_t kPage = 4096;

/// The disk under a file: what is surely on it, and what was written since.
class Disk {
 public:
  void apply(const DiskOperation& op) {
    if (op.kind == DiskOperation::barrier) {
      for (const DiskOperation& o : since_) put(stored_, o, 0, INT64_MAX);
      since_.clear();
    } else if (op.kind != DiskOperation::mark) {
      since_.push_back(op);
    }
  }

  /// What a power cut may leave now: of every page the bytes after some of the writes to it, and
  /// the size after some of the operations.
  std::vector<std::byte> after_power_cut(std::mt19937& random) const {
    std::vector<std::byte> disk = stored_;
    std::size_t size = stored_.size();
    const std::size_t sizes = random() % (since_.size() + 1);
    std::map<std::int64_t, std::size_t> kept;  // by page: the first so many operations
    for (std::size_t k = 0; k < since_.size(); ++k) {
      const DiskOperation& op = since_[k];
      const auto end = op.offset + static_cast<std::int64_t>(op.bytes.size());
      if (k < sizes)
        size = op.kind == DiskOperation::resize ? static_cast<std::size_t>(end)
                                                : std::max(size, static_cast<std::size_t>(end));
      if (op.kind == DiskOperation::resize) continue;
      for (std::int64_t s = op.offset / kPage; s * kPage < end; ++s) {
        const auto mine = kept.emplace(s, random() % (since_.size() + 1)).first;
        if (k < mine->second) put(disk, op, s * kPage, (s + 1) * kPage);
      }
    }
    disk.resize(size);
    return disk;
  }

 private:
  /// The part of an operation that lies in [from, to).
  static void put(std::vector<std::byte>& disk, const DiskOperation& op, std::int64_t from,
                  std::int64_t to) {
    if (op.kind == DiskOperation::resize) return disk.resize(static_cast<std::size_t>(op.offset));
    const auto size = static_cast<std::int64_t>(op.bytes.size());
    from = std::max(from, op.offset);
    to = std::min(to, op.offset + size);
    if (from >= to) return;
    if (static_cast<std::int64_t>(disk.size()) < to) disk.resize(static_cast<std::size_t>(to));
    std::copy(op.bytes.begin() + (from - op.offset), op.bytes.begin() + (to - op.offset),
              disk.begin() + from);
  }

  std::vector<std::byte> stored_;
  std::vector<DiskOperation> since_;
};

}  // namespace

TEST_CASE("a power cut at any moment leaves every reported frame, and no frame that is not whole",
          "[slow][run_file][many_states]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const bool gzip = GENERATE(false, true), split = GENERATE(false, true);
  const auto operations = operations_of_a_run(path, 50, gzip, split);
  Disk disk;
  std::mt19937 random(12);
  std::int64_t reported = 0, states = 0;
  for (std::size_t k = 0; k < operations.size(); ++k) {
    if (operations[k].kind == DiskOperation::mark) reported = operations[k].offset;
    disk.apply(operations[k]);
    if (reported == 0) continue;
    const std::vector<std::byte> left = disk.after_power_cut(random);
    const std::string copy = folder / "left.h5";
    std::ofstream(copy, std::ios::binary)
        .write(reinterpret_cast<const char*>(left.data()),
               static_cast<std::streamsize>(left.size()));
    ++states;
    INFO("state " << states << ", " << reported << " frames reported");
    const RunReader reader(copy);
    REQUIRE(reader.frames() >= reported);
    for (const std::int64_t f : {std::int64_t{0}, reported / 2, reported - 1, reader.frames() - 1})
      REQUIRE(same(reader.frame(f), split ? split_sample(f) : changing_sample(f)));
  }
  REQUIRE(states > 500);
}
