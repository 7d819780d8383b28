// HDF5 files that take in other files, in every way that HDF5 has: none is read by anything.
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "lib/base/error.h"
#include "lib/io/checkpoint.h"
#include "lib/io/h5_read.h"
#include "lib/io/particle_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

/// Makes a link of another class than hard and soft; external ones have class 64.
void user_link(hid_t file, const std::string& name, int kind, const std::string& data) {
  const auto nowhere = [](const char*, hid_t, const void*, size_t, hid_t, hid_t) -> hid_t {
    return -1;
  };
  H5L_class_t how{};
  how.version = H5L_LINK_CLASS_T_VERS;
  how.id = static_cast<H5L_type_t>(kind);
  how.trav_func = nowhere;
  REQUIRE(H5Lregister(&how) >= 0);
  const herr_t made =
      H5Lcreate_ud(file, name.c_str(), how.id, data.data(), data.size(), H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(H5Lunregister(how.id) >= 0);
  REQUIRE(made >= 0);
}

using Replace = std::function<void(hid_t file, const std::string& path)>;

/// The external file behind what a dataset of `rows` x 3 doubles is replaced with.
struct Way {
  const char* words;  ///< of the error
  Replace replace;
};

void external_link(hid_t file, const std::string& path, const std::string& to) {
  user_link(file, path, H5L_TYPE_EXTERNAL, std::string(1, '\0') + to + '\0' + "/position" + '\0');
}

std::vector<Way> ways(const std::string& other) {
  const auto dataset = [](hid_t file, const std::string& path, hid_t how) {
    const hsize_t dims[2] = {2, 3};
    const h5::Space space(H5Screate_simple(2, dims, nullptr));
    const h5::Dataset d(
        H5Dcreate2(file, path.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
  };
  return {
      {"external link", [=](hid_t f, const std::string& path) { external_link(f, path, other); }},
      {"user-defined", [=](hid_t f, const std::string& path) { user_link(f, path, 99, other); }},
      {"external link",  // behind a soft one
       [=](hid_t f, const std::string& path) {
         external_link(f, "away", other);
         h5::check(H5Lcreate_soft("/away", f, path.c_str(), H5P_DEFAULT, H5P_DEFAULT));
       }},
      {"soft link that leads to itself",
       [=](hid_t f, const std::string& path) {
         h5::check(H5Lcreate_soft("/ring", f, path.c_str(), H5P_DEFAULT, H5P_DEFAULT));
         h5::check(H5Lcreate_soft(("/" + path).c_str(), f, "ring", H5P_DEFAULT, H5P_DEFAULT));
       }},
      {"external storage",
       [=](hid_t f, const std::string& path) {
         const h5::Properties how(H5Pcreate(H5P_DATASET_CREATE));
         h5::check(H5Pset_external(how, other.c_str(), 0, 48));
         dataset(f, path, how);
       }},
      {"virtual dataset",
       [=](hid_t f, const std::string& path) {
         const hsize_t dims[2] = {2, 3};
         const h5::Space space(H5Screate_simple(2, dims, nullptr));
         const h5::Properties how(H5Pcreate(H5P_DATASET_CREATE));
         h5::check(H5Pset_virtual(how, space, other.c_str(), "/position", space));
         dataset(f, path, how);
       }},
  };
}

/// Another's file: as HDF5 and, for external storage, as bytes it holds two particles.
std::string others_file(const TemporaryFolder& folder) {
  const std::string path = folder / "other.h5";
  const h5::Lock lock;
  const h5::File file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  const hsize_t dims[2] = {2, 3};
  const double x[6] = {0.5, 0.5, 0.5, 0.75, 0.5, 0.5};
  const h5::Space space(H5Screate_simple(2, dims, nullptr));
  const h5::Dataset d(
      H5Dcreate2(file, "position", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  h5::check(H5Dwrite(d, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x));
  return path;
}

/// Puts `way` in the place of `path`, with `make` where the file is not there yet.
void change(const std::string& file_path, const std::string& path, const Replace& replace) {
  const h5::Lock lock;
  const bool there = std::filesystem::exists(file_path);
  const h5::File file(there ? H5Fopen(file_path.c_str(), H5F_ACC_RDWR, h5::file_access())
                            : H5Fcreate(file_path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT));
  if (there) h5::check(H5Ldelete(file, path.c_str(), H5P_DEFAULT));
  replace(file, path);
}

template <class Action>
void refused(const char* words, Action action) {
  std::string error = "no error";
  try {
    action();
  } catch (const Error& e) {
    error = e.what();
    CHECK(e.code() == ExitCode::io);
  }
  CAPTURE(error);
  CHECK(error.find(words) != std::string::npos);
}

std::string run_file(const TemporaryFolder& folder) {
  const std::string path = folder / "run.vtkhdf";
  std::filesystem::remove(path);
  RunWriter writer(path, sample_info(2), false);
  writer.log(sample_row(0));
  writer.write(sample(0, 2, ScalarType::f64));
  writer.finish({"finished"});
  return path;
}

}  // namespace

TEST_CASE("a particle file that takes in another file is refused, whatever the way") {
  const TemporaryFolder folder;
  const std::string other = others_file(folder), path = folder / "p.h5";
  CHECK(read_particle_file(other).size() == 2);
  for (const Way& way : ways(other)) {
    std::filesystem::remove(path);
    change(path, "position", way.replace);
    refused(way.words, [&] { read_particle_file(path); });
  }
}

TEST_CASE("soft links within a particle file are followed") {
  const TemporaryFolder folder;
  const std::string path = others_file(folder);
  const std::string target = GENERATE("/g/x", "g/x", "g/y");
  {
    const h5::Lock lock;
    const h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    const h5::Group g = h5::make_group(file, "g");
    h5::check(H5Lmove(file, "position", g, "x", H5P_DEFAULT, H5P_DEFAULT));
    h5::check(H5Lcreate_soft("x", g, "y", H5P_DEFAULT, H5P_DEFAULT));  // relative to its group
    h5::check(H5Lcreate_soft(target.c_str(), file, "position", H5P_DEFAULT, H5P_DEFAULT));
  }
  CHECK(read_particle_file(path).position.at(1)[0] == 0.75);
}

TEST_CASE("a run file that takes in another file is refused, whatever the way and the place",
          "[slow]") {
  const TemporaryFolder folder;
  const std::string other = others_file(folder);
  for (const char* place : {"VTKHDF/Points", "VTKHDF/PointData/velocity", "VTKHDF/Steps/Values",
                            "pbf/log/compression_mean", "pbf/sessions/host", "pbf/domain_min"})
    for (const Way& way : ways(other)) {
      const std::string path = run_file(folder);
      CAPTURE(place, way.words);
      change(path, place, way.replace);
      refused(way.words, [&] {
        try_run_file(path);
        const RunReader run(path);
        run.frame(0);
        run.info();
        run.sessions();
        for (const auto& name : run.log_columns()) run.log_column(name);
      });
      // Nor written to: what is appended to such a run file would go into the other file.
      try {
        RunWriter(path, sample_info(2), false, 1, {1, 0}).finish({"finished"});
      } catch (const Error&) {
      }
      CHECK(read_particle_file(other).position.at(1)[0] == 0.75);
    }
  const std::string path = run_file(folder);
  change(path, "VTKHDF/PointData",
         [&](hid_t f, const std::string& name) { external_link(f, name, other); });
  refused("external link", [&] { const RunReader run(path); });
}

TEST_CASE("a checkpoint that takes in another file is refused, whatever the way") {
  const TemporaryFolder folder;
  const std::string other = others_file(folder);
  SavedRun saved;
  saved.particles = 2;
  saved.state.precision = Precision::dbl;
  saved.state.position = saved.state.velocity = {0, 0, 0, 1, 1, 1};
  saved.state.id = {1, 0};
  for (const Way& way : ways(other)) {
    std::filesystem::remove(folder / "checkpoint.h5");
    write_checkpoint(folder.path, saved);
    change(folder / "checkpoint.h5", "position", way.replace);
    std::vector<std::string> notes;
    refused(way.words, [&] { read_checkpoint(folder.path, notes); });
  }
}

TEST_CASE("a file behind an external link is not opened: a pipe there makes nobody wait") {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe", path = folder / "p.h5";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  change(path, "position", ways(pipe)[0].replace);
  refused("external link", [&] { read_particle_file(path); });
  refused("FIFO", [&] { const RunReader run(pipe); });
  refused("FIFO", [&] { try_run_file(pipe), RunReader(pipe); });
}

TEST_CASE("a checkpoint that is a link to itself, a pipe or a folder is an I/O error, no crash") {
  SavedRun saved;
  saved.particles = 0;
  const std::vector<std::function<void(const std::string&)>> makes{
      [](const std::string& path) { std::filesystem::create_symlink("checkpoint.h5", path); },
      [](const std::string& path) { REQUIRE(mkfifo(path.c_str(), 0600) == 0); },
      [](const std::string& path) { std::filesystem::create_directory(path); }};
  for (const auto& make : makes) {
    const TemporaryFolder folder;
    make(folder / "checkpoint.h5");
    std::vector<std::string> notes;
    refused("remove it", [&] { read_checkpoint(folder.path, notes); });
    write_checkpoint(folder.path, saved);  // puts it aside
    CHECK(read_checkpoint(folder.path, notes));
  }
}

TEST_CASE("a checkpoint with a particle twice, or with a negative id, is damaged") {
  const TemporaryFolder folder;
  SavedRun saved;
  saved.particles = 2;
  saved.state.position = saved.state.velocity = {0, 0, 0, 1, 1, 1};
  for (const std::vector<std::int64_t>& ids :
       {std::vector<std::int64_t>{0, 0}, {-1, 0}, {1LL << 40, 1LL << 40}}) {
    saved.state.id = ids;
    std::filesystem::remove(folder / "checkpoint_prev.h5");
    std::filesystem::remove(folder / "checkpoint.h5");
    write_checkpoint(folder.path, saved);
    std::vector<std::string> notes;
    refused("dataset id", [&] { read_checkpoint(folder.path, notes); });
  }
}

TEST_CASE("HDF5 is not used by a thread that has not the lock") {
  CHECK_FALSE(h5::Lock::held());
  CHECK_THROWS_AS(h5::check(0), Error);
  {
    const h5::Lock lock;
    CHECK(h5::Lock::held());
    CHECK(h5::check(0) == 0);
    unsigned plugins = 1;
    CHECK(H5PLget_loading_state(&plugins) >= 0);
    CHECK(plugins == 0);  // nor does it load code that the environment names
    std::thread([] { CHECK_FALSE(h5::Lock::held()); }).join();
  }
  CHECK_FALSE(h5::Lock::held());
}

TEST_CASE("a particle file is read under the lock: it waits for who holds it") {
  const TemporaryFolder folder;
  const std::string path = others_file(folder);
  std::atomic<bool> done = false;
  std::optional<h5::Lock> lock(std::in_place);
  std::thread reader([&] { done = read_particle_file(path).size() == 2; });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  CHECK_FALSE(done);
  lock.reset();
  reader.join();
  CHECK(done);
}
