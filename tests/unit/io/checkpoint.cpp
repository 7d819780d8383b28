#include "lib/io/checkpoint.h"
#include "lib/run/guard.h"
#include "lib/scene/load.h"

#include <algorithm>
#include <filesystem>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_disk.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

SavedRun saved(Precision precision, std::int64_t update) {
  SavedRun s;
  s.particles = 3;
  s.state.precision = precision;
  s.state.updates = update;
  for (int k = 0; k < 9; ++k) {
    s.state.position.push_back(precision == Precision::dbl ? 0.1 * k : double(0.1f * float(k)));
    s.state.velocity.push_back(-1.5 * k);
  }
  s.state.id = {2, 0, 1};
  s.energy = {true, 1.25, 0.1, 1e-300};
  s.compression_max = 0.3;
  s.state.steps = 3 * update;
  s.state.fields = {{"counts", false, 4, {7, 1000, 12, 2.5}}};
  if (update == 7) {
    s.state.fields.push_back({"loads", false, 9, {}});
    for (int k = 0; k < 6 * 9; ++k)
      s.state.fields[1].values.push_back(k % 9 == 4 ? 5e-300 : k / 3.0 - 2);
    const bool wide = precision == Precision::dbl;
    s.state.fields.push_back({"temperature", true, 1, {wide ? 0.1 : 0.5, -3, 1e30f}});
  }
  if (update == 7) s.steps = StepHistory{2, 3, 32, 5, 0.125, 1.0 / 3, 11, 4, 6, 8, 5, {1, 0, 4}};
  s.first.kinetic_energy = 0.1;
  s.first.potential_energy = -3;
  s.first.compression_mean = 17.5;
  s.first.speed_max = 4.1;
  for (int k = 0; k < 3; ++k)
    s.first.center_of_mass[k] = 0.1 + k, s.first.momentum[k] = 1.0 / 3 - k;
  s.first.neighbors_max = 400;
  if (update == 7) s.released = 1.0 / 7;
  return s;
}

/// Whether a file says that the numbers have the solver's precision is not read back.
bool same_field(const StoredField& a, const StoredField& b) {
  return a.name == b.name && a.numbers == b.numbers && a.values == b.values;
}

bool same_saved(const SavedRun& a, const SavedRun& b) {
  return a.state.precision == b.state.precision && a.state.updates == b.state.updates &&
         a.state.position == b.state.position && a.state.velocity == b.state.velocity &&
         a.state.id == b.state.id && a.energy.started == b.energy.started &&
         a.energy.first == b.energy.first && a.energy.lowest == b.energy.lowest &&
         a.energy.rise == b.energy.rise && a.compression_max == b.compression_max &&
         a.particles == b.particles && a.state.steps == b.state.steps &&
         std::equal(a.state.fields.begin(), a.state.fields.end(), b.state.fields.begin(),
                    b.state.fields.end(), same_field) &&
         a.steps == b.steps && a.released == b.released &&
         std::equal(a.first.momentum, a.first.momentum + 3, b.first.momentum);
}

bool same_limits(const GuardLimits& a, const GuardLimits& b) {
  return a.speed == b.speed && a.energy == b.energy && a.neighbors == b.neighbors;
}

}  // namespace

TEST_CASE("the guard of a resumed run has the limits of the run from its start") {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  const Scene scene = load_scene(PBF_SOURCE_DIR "/configs/dam_break.yaml", {}).scene;
  const Plan plan = make_plan(scene, 3);
  const SavedRun first = saved(Precision::dbl, 10);
  write_checkpoint(folder.path, first);
  const auto read = read_checkpoint(folder.path, notes);
  REQUIRE(read);
  const GuardLimits limits = guard_limits(scene, plan, first.first);
  CHECK(same_limits(limits, guard_limits(scene, plan, read->first)));
  CHECK_FALSE(same_limits(limits, guard_limits(scene, plan, Diagnostics{})));
}

TEST_CASE("a checkpoint comes back to the last bit, and the one before is kept") {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  CHECK_FALSE(read_checkpoint(folder.path, notes));
  for (const Precision p : {Precision::single, Precision::dbl}) {
    write_checkpoint(folder.path, saved(p, 5));
    write_checkpoint(folder.path, saved(p, 7));
    const auto read = read_checkpoint(folder.path, notes);
    REQUIRE(read);
    CHECK(same_saved(*read, saved(p, 7)));
    std::filesystem::remove(folder / "checkpoint.h5");
    CHECK(same_saved(*read_checkpoint(folder.path, notes), saved(p, 5)));
    CHECK(notes.empty());
  }
  CHECK_FALSE(std::filesystem::exists(folder / "checkpoint.h5.tmp"));
}

TEST_CASE("a disk that is full leaves the checkpoint before") {
  const TemporaryFolder folder;
  write_checkpoint(folder.path, saved(Precision::dbl, 5));
  std::vector<std::string> notes;
  for (const std::int64_t capacity : {0, 100, 1000, 3000}) {
    CAPTURE(capacity);
    const WatchedDisk disk(folder / "checkpoint.h5.tmp", capacity, false);
    try {
      write_checkpoint(folder.path, saved(Precision::dbl, 7));
      FAIL("written to a full disk");
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::io);
      CHECK(std::string(e.what()).find("No space left") != std::string::npos);
    }
    CHECK(same_saved(*read_checkpoint(folder.path, notes), saved(Precision::dbl, 5)));
    CHECK_FALSE(std::filesystem::exists(folder / "checkpoint.h5.tmp"));
  }
}
