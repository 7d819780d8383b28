// What a file that is being written leaves in its folder.
#include "lib/base/output_file.h"

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <thread>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

using namespace pbf;
namespace fs = std::filesystem;

namespace {

std::size_t entries(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), {}));
}

std::string error_of(const std::function<void()>& action, ExitCode code) {
  try {
    action();
  } catch (const Error& e) {
    CHECK(e.code() == code);
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("an output takes its place at the end alone, and without an end leaves nothing") {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  write_text_file(path, "old");
  {
    OutputFile file(path, Naming::given);
    file.write("new");
    CHECK(test::read_file(path) == "old");
    CHECK(entries(folder.path) <= 2);  // 1 where the file system knows files without a name
  }
  CHECK(test::read_file(path) == "old");
  CHECK(entries(folder.path) == 1);
  OutputFile file(path, Naming::own);
  file.write("ne");
  file.write("w");
  file.finish(false);
  CHECK(test::read_file(path) == "new");
  CHECK(entries(folder.path) == 1);
}

TEST_CASE("files written at the same time under one name are each whole") {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  std::vector<std::thread> writers;
  for (const char c : {'a', 'b', 'c', 'd'})
    writers.emplace_back([&path, c] {
      for (int k = 0; k < 50; ++k) write_text_file(path, std::string(20000, c));
    });
  for (int k = 0; k < 200; ++k)
    if (const std::string text = test::read_file(path); !text.empty()) {
      REQUIRE(text.size() == 20000);
      REQUIRE(text == std::string(20000, text[0]));
    }
  for (std::thread& t : writers) t.join();
  CHECK(entries(folder.path) == 1);
}

TEST_CASE("a name as long as the file system takes is written") {
  const test::TemporaryFolder folder;
  const std::string name(255, 'x');
  write_text_file(folder / name.c_str(), "text");
  CHECK(test::read_file(folder / name.c_str()) == "text");
}

TEST_CASE("a name of the program's own is never a link or a FIFO") {
  const test::TemporaryFolder folder;
  write_text_file(folder / "victim", "precious");
  fs::create_symlink("victim", folder / "link");
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  for (const char* name : {"link", "fifo"}) {
    const std::string error =
        error_of([&] { write_text_file(folder / name, "x", Naming::own); }, ExitCode::io);
    CHECK(error.find("remove it, or give another folder with --out") != std::string::npos);
  }
  CHECK(test::read_file(folder / "victim") == "precious");
  write_text_file(folder / "link", "changed");  // a name that the user gave
  CHECK(test::read_file(folder / "victim") == "changed");
  CHECK(fs::is_symlink(fs::symlink_status(folder / "link")));
}

TEST_CASE("an input is refused as an output by whatever name, until it is gone") {
  const test::TemporaryFolder folder;
  write_text_file(folder / "scene", "precious");
  fs::create_hard_link(folder / "scene", folder / "hard");
  fs::create_symlink("scene", folder / "soft");
  note_input(folder / "scene");
  for (const char* name : {"scene", "hard", "soft"}) {
    CHECK(error_of([&] { write_text_file(folder / name, "x"); }, ExitCode::bad_input)
              .find("which this command reads") != std::string::npos);
    CHECK(error_of([&] { open_output_stream(folder / name, true); }, ExitCode::bad_input)
              .find("which this command reads") != std::string::npos);
  }
  CHECK(test::read_file(folder / "scene") == "precious");
  fs::remove(folder / "scene");
  write_text_file(folder / "hard", "free");
  CHECK(test::read_file(folder / "hard") == "free");
}

TEST_CASE("two paths to one file are told apart from two files") {
  const test::TemporaryFolder folder;
  fs::create_symlink("new", folder / "link");
  CHECK(same_output(folder / "new", folder / "./new"));
  CHECK(same_output(folder / "new", folder / "link"));
  CHECK_FALSE(same_output(folder / "new", folder / "other"));
  CHECK_FALSE(same_output("/dev/null", "/dev/null"));
  CHECK(is_stream("/dev/null"));
  CHECK_FALSE(is_stream(folder / "new"));
}
