// The size of the program. A module that grows beyond its number shrinks elsewhere, or the number
// is raised in the same commit, whose message says what for.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "tests/support/catch.h"

namespace pbf::budget_test {
namespace {

namespace fs = std::filesystem;

/// Lines of sources (.h .cpp .cu .cuh).
const std::map<std::string, int> kBudget = {
    {"app", 2700},        {"kernels", 8520},  {"lib/base", 1870},   {"lib/campaign", 4720},
    {"lib/data", 1590},   {"lib/exec", 8040}, {"lib/io", 4370},     {"lib/program", 10030},
    {"lib/render", 3950}, {"lib/run", 6450},  {"lib/scene", 10550}, {"lib/solver", 3360},
    {"lib/verify", 2160},
};
constexpr int kLongestFile = 300;

bool is_source(const fs::path& path) {
  const std::string e = path.extension().string();
  return e == ".h" || e == ".cpp" || e == ".cu" || e == ".cuh";
}
int lines_of(const fs::path& path) {
  std::ifstream file(path);
  return int(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
}

}  // namespace

TEST_CASE("no module is larger than its budget, and no file longer than 300 lines") {
  const fs::path root = PBF_SOURCE_DIR;
  std::map<std::string, int> lines;
  for (const char* folder : {"app", "kernels", "lib"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!is_source(entry.path())) continue;
      const fs::path path = fs::relative(entry.path(), root);
      auto part = path.begin();
      std::string module = part->string();
      if (module == "lib") module += "/" + (++part)->string();
      const int n = lines_of(entry.path());
      lines[module] += n;
      CAPTURE(path.string());
      CHECK(n <= kLongestFile);
    }
  for (const auto& [module, n] : lines) {
    CAPTURE(module);
    REQUIRE(kBudget.contains(module));
    CHECK(n <= kBudget.at(module));
    CHECK(n > kBudget.at(module) - 200);  // what has shrunk stays small
  }
  CHECK(lines.size() == kBudget.size());
}

}  // namespace pbf::budget_test
