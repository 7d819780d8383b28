// Results of the runs of a batch, read while others are under way.
#include "lib/campaign/run_results.h"

#include <stdexcept>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/run_file_samples.h"

namespace pbf::run_results_test {
namespace {

using test::TemporaryFolder;

const BatchMember kOne{"one", "one.yaml", {}}, kTwo{"two", "two.yaml", {}};

void write_run(const TemporaryFolder& folder, const BatchMember& m, std::int64_t frames) {
  std::filesystem::create_directories(folder.path / m.name);
  RunWriter file(folder / (m.name + "/run.vtkhdf").c_str(), test::sample_info(3), false);
  for (std::int64_t k = 0; k < frames; ++k) file.write(test::sample(k, 3));
  file.finish({"finished", "", frames, {}});
}

Scene no_scene(const BatchMember&) { throw Error(ExitCode::bad_input, "no scene"); }

Cell cell(const FileResults& r, const std::string& column) {
  const std::vector<std::string> columns = file_columns();
  return r.cells.at(std::size_t(std::ranges::find(columns, column) - columns.begin()));
}

}  // namespace

TEST_CASE("results: a run is read when it ends, the others when results are asked for") {
  const TemporaryFolder folder;
  RunResults results(folder.path.string(), no_scene);
  write_run(folder, kOne, 2);
  results.read(kOne);
  CHECK(cell(results.of({kOne}).at(0), "frames") == Cell{std::int64_t{2}});
  std::filesystem::remove_all(folder.path / kOne.name);  // what was read stays
  write_run(folder, kTwo, 1);
  const std::vector<FileResults> both = results.of({kTwo, kOne});
  CHECK(cell(both.at(0), "frames") == Cell{std::int64_t{1}});
  CHECK(cell(both.at(1), "frames") == Cell{std::int64_t{2}});
}

TEST_CASE("results: all cells are empty without a run file, and with one that cannot be read") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path / kTwo.name);
  folder.write("two/run.vtkhdf", "no run file");
  RunResults results(folder.path.string(), no_scene);
  for (const FileResults& r : results.of({kOne, kTwo})) {
    CHECK(r.cells == std::vector<Cell>(file_columns().size()));
    CHECK(r.readings.empty());
  }
}

TEST_CASE("results: what goes wrong beside runs is thrown where results are asked for") {
  const TemporaryFolder folder;
  RunResults results(folder.path.string(),
                     [](const BatchMember&) -> Scene { throw std::runtime_error("lost"); });
  write_run(folder, kOne, 1);
  results.read(kOne);
  results.read(kTwo);  // nothing more is read, and nobody waits for it
  CHECK_THROWS_WITH(results.of({kOne, kTwo}), "lost");
}

}  // namespace pbf::run_results_test
