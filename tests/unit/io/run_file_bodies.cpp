// The free bodies of every frame of a run file.
#include <filesystem>

#include "lib/base/error.h"
#include "lib/io/h5_output.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

constexpr std::int64_t kBodyFrames = 150;  // more than one chunk has

std::string file_with_bodies(const TemporaryFolder& folder) {
  const std::string path = folder / "bodies.vtkhdf";
  RunWriter writer(path, changing_info(), false);
  for (std::int64_t k = 0; k < kBodyFrames; ++k) writer.write(changing_sample(k));
  writer.finish({"finished"});
  return path;
}

/// Changes the dataset of the bodies of the file.
template <class Change>
void change_bodies(const std::string& path, const Change& change) {
  const h5::Lock lock;
  const h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDWR, h5::file_access()));
  change(h5::open_group(file, "pbf/frames"));
}

std::string reason_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::io);
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the bodies of every frame come back, with their names and columns", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = file_with_bodies(folder);
  const RunReader reader(path);
  REQUIRE(reader.frames() == kBodyFrames);
  for (std::int64_t k = 0; k < kBodyFrames; ++k) {
    REQUIRE(reader.frame(k).bodies == sample_bodies(k));
    REQUIRE(reader.bodies(k) == sample_bodies(k));
  }
  CHECK_THROWS_AS(reader.bodies(kBodyFrames), Error);
  CHECK(reader.info().bodies == std::vector<std::string>{"float", "raft"});
  const h5::Lock lock;
  const h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, h5::file_access()));
  const h5::Dataset d = h5::open_dataset(file, "pbf/frames/bodies");
  CHECK(h5::shape(d) == std::vector<hsize_t>{kBodyFrames, 2, 18});
  const std::vector<std::string> columns = h5::read_texts(d, "columns"),
                                 units = h5::read_texts(d, "units");
  REQUIRE(columns.size() == 18);
  REQUIRE(units.size() == 18);
  CHECK(columns[2] == "z");
  CHECK(columns[4] == "turn_xy");
  CHECK(columns[12] == "velocity_x");
  CHECK(columns[17] == "spin_z");
  CHECK(units[0] == "m");
  CHECK(units[17] == "rad/s");
}

TEST_CASE("a run without free bodies has nothing of them in its file", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  RunWriter writer(path, sample_info(40), false);
  writer.write(sample(0, 40));
  writer.finish({"finished"});
  const RunReader reader(path);
  CHECK(reader.frame(0).bodies.empty());
  CHECK(reader.info().bodies.empty());
  const h5::Lock lock;
  const h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, h5::file_access()));
  CHECK(h5::children(h5::open_group(file, "pbf/frames"), H5O_TYPE_DATASET) ==
        std::vector<std::string>{"update"});
}

TEST_CASE("a frame with other bodies than the run is refused", "[run_file]") {
  const TemporaryFolder folder;
  for (const bool with : {false, true}) {
    RunWriter writer(folder / (with ? "a.h5" : "b.h5"), with ? changing_info() : sample_info(40),
                     false);
    Snapshot s = with ? changing_particles(0) : changing_sample(0);
    try {
      writer.write(std::move(s));
      writer.sync();
      FAIL("it was written");
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::internal);
      CHECK(std::string(e.what()).find("free bodies") != std::string::npos);
    }
  }
}

TEST_CASE("the bodies of frames that a resumed run makes again are replaced", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = file_with_bodies(folder);
  RunInfo other = changing_info();
  other.bodies = {"float", "boat"};
  CHECK(reason_of([&] { RunWriter(path, other, false, 70, {}); }).find("not of these bodies") !=
        std::string::npos);
  RunWriter writer(path, changing_info(), false, 70, {});
  CHECK(RunReader(path).frames() == 70);
  for (std::int64_t k = 70; k < 80; ++k) {
    Snapshot s = changing_sample(k);
    s.bodies = sample_bodies(3 * k);
    writer.write(std::move(s));
  }
  writer.finish({"finished"});
  const RunReader reader(path);
  REQUIRE(reader.frames() == 80);
  for (std::int64_t k = 0; k < 80; ++k)
    REQUIRE(reader.bodies(k) == sample_bodies(k < 70 ? k : 3 * k));
}

TEST_CASE("damaged bodies are refused with the reason, and a short dataset ends the frames",
          "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = file_with_bodies(folder);
  const auto changed = [&](const char* name, const auto& change) {
    const std::string copy = folder / name;
    std::filesystem::copy_file(path, copy);
    change_bodies(copy, change);
    return copy;
  };
  const std::string other = changed("other.h5", [](const h5::Group& frames) {
    h5::check(H5Ldelete(frames, "bodies", H5P_DEFAULT));
    const std::vector<double> few(36);
    h5::write_dataset(frames, "bodies", H5T_IEEE_F64LE, {2, 18}, H5T_NATIVE_DOUBLE, few.data(), "");
  });
  CHECK(reason_of([&] { const RunReader reader(other); }).find("/pbf/frames/bodies has a shape") !=
        std::string::npos);
  const std::string cut = changed("cut.h5", [](const h5::Group& frames) {
    const hsize_t size[3] = {5, 2, 18};
    h5::check(H5Dset_extent(h5::open_dataset(frames, "bodies"), size));
  });
  CHECK(RunReader(cut).frames() == 5);
  CHECK(reason_of([&] {
          RunWriter(cut, changing_info(), false, 6, {});
        }).find("ends before what the file says") != std::string::npos);
}
