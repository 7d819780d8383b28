#include "lib/io/particle_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"
#include "lib/io/h5_read.h"
#include "lib/io/h5_signature.h"
#include "lib/io/h5_trial.h"
#include "lib/io/particle_csv.h"

namespace pbf::inline io_module {
namespace {

RegularFile open_file(const std::string& path) {
  note_input(path);
  return RegularFile(path, "a particle file (CSV or HDF5)",
                     "; paths of file bodies are relative to the folder of the scene file");
}

bool is_hdf5(RegularFile& file) {
  char head[8];
  const std::size_t n = file.read(head, sizeof head);
  file.rewind();
  return h5::is_signature({head, n});
}

/// Rows of dataset `name`, which must be (N, 3) numbers; fills `out` when given.
std::int64_t read_rows(hid_t file, const std::string& path, const char* name,
                       std::vector<Double3>* out) {
  const std::string where = path + ": dataset " + name;
  const h5::Dataset data = h5::open_dataset(file, name);
  const h5::Type type(H5Dget_type(data));
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) bad_input(where, "does not hold numbers");
  const std::vector<hsize_t> dims = h5::shape(data);
  if (dims.size() != 2) bad_input(where, "has the wrong rank, expected (N, 3)");
  if (dims[1] != 3)
    bad_input(where, "has " + std::to_string(dims[1]) + " columns, expected 3: x, y, z");
  if (dims[0] > 2147483647u)
    bad_input(where, "has " + std::to_string(dims[0]) + " rows; at most 2147483647 particles fit");
  h5::claimed(data, dims, sizeof(double));
  if (out != nullptr) {
    out->resize(dims[0]);
    if (dims[0] > 0)
      h5::check(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out->data()));
    for (std::size_t i = 0; i < out->size(); ++i)
      for (double value : (*out)[i])
        if (!std::isfinite(value)) bad_input(where, "row " + std::to_string(i) + " is not finite");
  }
  return static_cast<std::int64_t>(dims[0]);
}

struct stat state_of(int fd) {
  struct stat s {};
  if (::fstat(fd, &s) != 0) throw h5::Failure(std::strerror(errno));
  return s;
}

/// Of all bytes of the file that HDF5 has open.
std::string hash_of(int fd) {
  Sha256 hash;
  std::vector<char> block(std::size_t{1} << 18);
  for (off_t at = 0;;) {
    const ssize_t n = ::pread(fd, block.data(), block.size(), at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw h5::Failure(std::strerror(errno));
    if (n == 0) return hash.text();
    hash.add({block.data(), static_cast<std::size_t>(n)});
    at += n;
  }
}

/// Reads into `out` when given; returns the number of particles. sha256, when given, is that of
/// what was read: from the same descriptor, and nobody has written there meanwhile.
std::int64_t read_hdf5(const std::string& path, Particles* out, std::string* sha256) {
  try {
    const h5::Reading file(path);
    const struct stat before = state_of(h5::descriptor(file));
    if (sha256) *sha256 = hash_of(h5::descriptor(file));
    if (!h5::has_link(file, "position"))
      bad_input(path + ": dataset position", "is missing; a particle file needs position (N, 3)");
    const auto count = read_rows(file, path, "position", out ? &out->position : nullptr);
    if (h5::has_link(file, "velocity")) {
      const auto rows = read_rows(file, path, "velocity", out ? &out->velocity : nullptr);
      if (rows != count)
        bad_input(path, "position has " + std::to_string(count) + " rows, velocity " +
                            std::to_string(rows) + "; they must agree");
    } else if (out != nullptr) {
      out->velocity.assign(static_cast<std::size_t>(count), Double3{});
    }
    const struct stat after = state_of(h5::descriptor(file));
    if (after.st_size != before.st_size || after.st_mtim.tv_sec != before.st_mtim.tv_sec ||
        after.st_mtim.tv_nsec != before.st_mtim.tv_nsec)
      throw h5::Failure("it was written to while it was read; wait until it is whole");
    return count;
  } catch (const h5::Failure& f) {
    throw Error(ExitCode::io, path + ": cannot be read as a particle file: " + f.what());
  }
}

}  // namespace

Particles read_particle_file(const std::string& path, std::string* sha256) {
  RegularFile file = open_file(path);
  Particles p;
  if (is_hdf5(file)) {
    read_hdf5(path, &p, sha256);
    return p;
  }
  Sha256 hash;
  p = read_particle_csv(file, path, sha256 ? &hash : nullptr);
  if (sha256) *sha256 = hash.text();
  return p;
}

std::int64_t count_particle_file(const std::string& path) {
  RegularFile file = open_file(path);
  if (!is_hdf5(file)) return count_particle_csv(file, path);
  h5::trial(path, [&path] {
    Particles p;
    read_hdf5(path, &p, nullptr);
  });
  return read_hdf5(path, nullptr, nullptr);
}

}  // namespace pbf::inline io_module
