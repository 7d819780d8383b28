// Particle files: CSV and HDF5, read strictly.
#include <hdf5.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "lib/base/regular_file.h"
#include "lib/io/particle_file.h"
#include "lib/run/emit.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

std::string read_error(const std::string& path) {
  return error_of([&] { read_particle_file(path); });
}

/// Writes `values` as a dataset of the given shape.
void put(hid_t file, const char* name, std::vector<hsize_t> dims,
         const std::vector<double>& values) {
  const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
  const hid_t data =
      H5Dcreate2(file, name, H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (!values.empty())
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(data);
  H5Sclose(space);
}

struct Dataset {
  const char* name;
  std::vector<hsize_t> dims;
  std::vector<double> values;
};

std::string write_h5(const Folder& folder, const std::vector<Dataset>& datasets) {
  const std::string path = (folder.path / "p.h5").string();
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  for (const Dataset& d : datasets) put(file, d.name, d.dims, d.values);
  H5Fclose(file);
  return path;
}

}  // namespace

TEST_CASE("CSV: positions and velocities, in the order of the lines") {
  const Folder folder;
  const Particles p = read_particle_file(
      folder.write("p.csv", "x,y,z,vx,vy,vz\n0.1,0.2,0.3,1,-2,3e-1\n.5,+0.6,7e-1,0,0,0\n"));
  REQUIRE(p.size() == 2);
  CHECK(p.position[0] == Double3{0.1, 0.2, 0.3});
  CHECK(p.velocity[0] == Double3{1, -2, 0.3});
  CHECK(p.position[1] == Double3{0.5, 0.6, 0.7});
}

TEST_CASE("CSV: blanks, CRLF, empty lines and a missing last line end are tolerated") {
  const Folder folder;
  const std::string path = folder.write("p.csv", "\xEF\xBB\xBF x , y,z\r\n 1 ,\t2, 3\r\n\r\n4,5,6");
  const Particles p = read_particle_file(path);
  REQUIRE(p.size() == 2);
  CHECK(p.position[1] == Double3{4, 5, 6});
  CHECK(p.velocity[1] == Double3{0, 0, 0});
}

TEST_CASE("CSV: what is wrong is named with its line") {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "p.csv: empty, expected a header"},
      {"1,2,3\n",
       "p.csv:1: the first line holds numbers, no header, expected x,y,z or x,y,z,vx,vy"},
      {"x,y\n", "p.csv:1: the header is \"x,y\", expected x,y,z or x,y,z,vx,vy,vz"},
      {"x;y;z\n", "p.csv:1: the header is \"x;y;z\""},
      {"x,y,z\n1,2,3\n1,2\n", "p.csv:3: 2 columns, the header has 3"},
      {"x,y,z\n1,2,3,4\n", "p.csv:2: 4 columns, the header has 3"},
      {"x,y,z\n1,2,3,\n", "p.csv:2: 4 columns"},
      {"x,y,z\n1,,3\n", "p.csv:2: y: empty, expected a number"},
      {"x,y,z\n1,2,abc\n", "p.csv:2: z: \"abc\" is not a number"},
      {"x,y,z\n1,2,3 4\n", "p.csv:2: z: \"3 4\" is not a number"},
      {"x,y,z\n1,2,0x3\n", "is not a number"},
      {"x,y,z\n1,2,+-3\n", "is not a number"},
      {"x,y,z\n\n1,2,nan\n", "p.csv:3: z: \"nan\" is not finite"},
      {"x,y,z\n-inf,2,3\n", "p.csv:2: x: \"-inf\" is not finite"},
      {"x,y,z\n1e999,2,3\n", "p.csv:2: x: \"1e999\" does not fit a double"},
      {"x,y,z,vx,vy,vz\n1,2,3,4,5,inf\n", "p.csv:2: vz: \"inf\" is not finite"},
  };
  for (const auto& [text, message] : cases) {
    const std::string error = read_error(folder.write("p.csv", text));
    CAPTURE(text, error);
    CHECK(contains(error, message));
    CHECK(error[0] == '2');
  }
}

TEST_CASE("CSV: an error shows nothing of a file that is no particle file") {
  const Folder folder;
  const std::string secret = "root:$y$j9T$F5Jx5fExrKuPp53x:19000:0:99999:7:::";
  const std::vector<std::string> files{
      secret + "\nx,y,z\n",       "short:pw\n",
      "pin 1234,abc\n",           std::string("\x1b]0;title\x07 x,y,z\n"),
      "x,y,z\n1,2,\x1b[31mred\n", "x,y,z\n" + std::string(100000, 'k') + "\n"};
  for (const std::string& text : files) {
    const std::string path = folder.write("p.csv", text), error = read_error(path);
    CAPTURE(text.substr(0, 100), error);
    CHECK(error[0] == '2');
    std::string told = error;  // but for the folder's random name
    told.erase(told.find(path), path.size());
    for (const char* part : {"root", "$y$", "short", "pw", "1234", "abc", "title", "red", "kk"})
      CHECK_FALSE(contains(told, part));
    CHECK(std::all_of(error.begin(), error.end(), [](char c) { return c >= ' '; }));
    CHECK(error.size() < 300);
  }
}

TEST_CASE("a particle file is hashed as it is read, to what sha256sum says of it") {
  const Folder folder;
  const std::vector<std::string> paths{
      folder.write("a.csv", "x,y,z\n0.5,0.5,0.5"), folder.write("b.csv", "x,y,z\r\n\r\n1,2,3\r\n"),
      folder.write(
          "c.csv", "x,y,z\n" +
                       [] {
                         std::string rows;
                         for (int k = 0; k < 20000; ++k)
                           rows += std::to_string(k) + ",0.25,0.125\n";
                         return rows;
                       }()),
      write_h5(folder, {{"position", {2, 3}, {0, 0.5, 1, 2, 3, 4}}})};
  for (const std::string& path : paths) {
    std::string hash;
    read_particle_file(path, &hash);
    const std::string out = (folder.path / "sum").string();
    REQUIRE(std::system(("sha256sum " + path + " > " + out).c_str()) == 0);
    CHECK(read_file(out).substr(0, 64) == hash);
  }
}

TEST_CASE("HDF5: positions, velocities if there, any number type") {
  const Folder folder;
  const Particles p =
      read_particle_file(write_h5(folder, {{"position", {2, 3}, {0, 0.5, 1, 2, 3, 4}},
                                           {"velocity", {2, 3}, {1, 2, 3, 4, 5, 6}}}));
  REQUIRE(p.size() == 2);
  CHECK(p.position[0] == Double3{0, 0.5, 1});
  CHECK(p.velocity[1] == Double3{4, 5, 6});
  const std::string path = write_h5(folder, {{"position", {1, 3}, {1, 2, 3}}});
  CHECK(read_particle_file(path).velocity == std::vector<Double3>{{0, 0, 0}});
}

TEST_CASE("HDF5: what is wrong is named with its dataset") {
  const Folder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error = [&](const std::vector<Dataset>& d) { return read_error(write_h5(folder, d)); };
  CHECK(contains(error({}), "p.h5: dataset position: is missing"));
  CHECK(contains(error({{"position", {3}, {1, 2, 3}}}), "position: has the wrong rank"));
  CHECK(contains(error({{"position", {1, 2}, {1, 2}}}), "has 2 columns, expected 3"));
  CHECK(contains(error({{"position", {2, 3}, {1, 2, 3, 4, 5, nan}}}), "row 1 is not finite"));
  CHECK(contains(error({{"position", {1, 3}, {1, 2, 3}}, {"velocity", {2, 3}, {1, 2, 3, 4, 5, 6}}}),
                 "position has 1 rows, velocity 2"));
  // A file cut off after its signature; HDF5 itself stays silent.
  const std::string cut = folder.write("cut.h5", std::string("\x89HDF\r\n\x1a\n", 8) + "rest");
  CHECK(contains(read_error(cut), "5 " + cut + ": cannot be read as a particle file"));
}

TEST_CASE("HDF5: what a file claims is checked before memory is taken for it") {
  const Folder folder;
  const std::string path = (folder.path / "p.h5").string();
  const auto claim = [&](hsize_t rows, hsize_t chunk, bool deflate) {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t dims[2] = {rows, 3}, most[2] = {H5S_UNLIMITED, 3}, chunks[2] = {chunk, 3};
    const hid_t space = H5Screate_simple(2, dims, most), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 2, chunks);
    const double half = 0.5;
    H5Pset_fill_value(how, H5T_NATIVE_DOUBLE, &half);
    if (deflate) H5Pset_deflate(how, 1);
    H5Dclose(H5Dcreate2(file, "position", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(how);
    H5Fclose(file);
    return read_error(path);
  };
  CHECK(
      contains(claim(1000000000000, 100, false), "2 " + path + ": dataset position: has 1000000"));
  CHECK(contains(claim(2000000000, 100, false), "dataset /position claims more rows"));
  // One chunk of 3 GB for two rows: HDF5 would make it as a whole.
  CHECK(contains(claim(2, hsize_t{1} << 27, true), "dataset /position claims more rows"));
  CHECK(claim(2, 100, true) == "no error");
}

TEST_CASE("particle files: missing ones and what is no regular file are I/O errors") {
  const Folder folder;
  CHECK(contains(read_error((folder.path / "no.csv").string()), "cannot be opened"));
  CHECK(read_error((folder.path / "no.csv").string())[0] == '5');
  CHECK(contains(read_error(folder.path.string()), "is a folder"));
  const std::string pipe = (folder.path / "pipe").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(contains(read_error(pipe), "5 " + pipe + ": is a FIFO, expected a particle"));
  CHECK(contains(read_error("/dev/zero"), "5 /dev/zero: is a device"));
}

TEST_CASE("an open file tells what is written to it, and not of another one that takes its name") {
  const Folder folder;
  const std::string path = folder.write("p.csv", "x,y,z\n"), other = folder.write("q.csv", "x");
  const RegularFile file(path, "a table", "");
  const auto stamp = file.stamp();
  CHECK(stamp.first == 6);
  std::filesystem::rename(other, path);
  CHECK(file.stamp() == stamp);
  const RegularFile renamed(path, "a table", "");
  folder.write("p.csv", "x,y");
  CHECK(renamed.stamp().first == 3);
}

TEST_CASE("file body: path relative to the scene file, velocity added, domain enforced") {
  const Folder folder;
  folder.write("p.csv", "x,y,z,vx,vy,vz\n0.5,0.5,0.5,1,0,0\n");
  const Scene s = parse(with_bodies("[{shape: file, path: p.csv, velocity: [0, 0, 2]}]"));
  const Particles p = emit_particles(s, folder.path.string());
  REQUIRE(p.size() == 1);
  CHECK(p.velocity[0] == Double3{1, 0, 2});
  folder.write("p.csv", "x,y,z\n0.5,0.5,0.5\n0.5,0.5,-0.1\n");
  CHECK(contains(error_of([&] { emit_particles(s, folder.path.string()); }),
                 "bodies[0]: particle 1 at [0.5, 0.5, -0.1] is outside the domain along z"));
  folder.write("p.csv", "x,y,z\n");
  CHECK(
      contains(error_of([&] { count_particles(s, folder.path.string()); }), "holds no particles"));
}

}  // namespace pbf::scene_test
