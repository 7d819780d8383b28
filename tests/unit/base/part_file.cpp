#include "lib/base/part_file.h"

#include <fstream>
#include <iterator>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

using namespace pbf;
using namespace pbf::test;

namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

TEST_CASE("parts of a file go where they belong, whoever writes first") {
  const TemporaryFolder folder;
  const std::string path = folder / "f";
  std::ofstream(path) << "..........";
  const std::string a = "abc", b = "xyz";
  PartFile one(path), other(path);
  other.write({{6, bytes_of(b)}}, nullptr);
  one.write({{1, bytes_of(a)}, {9, bytes_of(b)}}, nullptr);
  CHECK(one.done(true));
  CHECK(other.done(true));
  std::ifstream file(path);
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == ".abc..xyzxyz");
}

TEST_CASE("a part for which the disk has no room is an error that names the file and the reason") {
  PartFile full("/dev/full");
  const std::string a = "abc";
  full.write({{0, bytes_of(a)}}, nullptr);
  CHECK_THROWS_WITH(full.done(true),
                    "/dev/full: cannot write this rank's part of a frame: No space left on "
                    "device; the frames before it are kept");
  CHECK_THROWS_AS(full.done(false), Error);
  CHECK_THROWS_WITH(PartFile("/nowhere/run.h5"), Catch::Contains("No such file"));
}

TEST_CASE("processes know a file by its number: that of another file differs, none is 0") {
  const TemporaryFolder folder;
  const std::string path = folder / "f";
  std::ofstream(path) << "1";
  std::ofstream(folder / "g") << "1";
  CHECK(inode_of(path) != 0);
  CHECK(inode_of(path) == inode_of(folder / "f"));
  CHECK(inode_of(path) != inode_of(folder / "g"));
  CHECK(inode_of(folder / "h") == 0);
}

TEST_CASE("a folder in which a part is written is waited for, until the last of them has ended") {
  const TemporaryFolder folder;
  const std::string path = folder / "f";
  std::ofstream(path) << "1";
  CHECK(wait_for_parts(folder.path.string(), 0));
  {
    PartFile one(path);
    const auto other = std::make_unique<PartFile>(path);
    CHECK(!wait_for_parts(folder.path.string(), 0.05));
  }
  CHECK(wait_for_parts(folder.path.string(), 0));
  CHECK(wait_for_parts("/nowhere", 0));
}
