#include "lib/io/particle_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/machine.h"
#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"
#include "lib/base/text.h"
#include "lib/io/h5_read.h"
#include "lib/io/h5_signature.h"
#include "lib/io/h5_trial.h"
#include "lib/io/particle_csv.h"

namespace pbf::io_module {
namespace {

/// `available`: bytes of memory that are available.
void must_fit(const std::string& what, std::size_t bytes, std::size_t available) {
  if (bytes > available)
    throw Error(ExitCode::unavailable, what + ": needs " + bytes_text(double(bytes)) +
                                           " of memory, " + bytes_text(double(available)) +
                                           " are available; use a machine with more memory");
}

/// Rows of dataset `name`, which must be (N, 3) numbers.
std::vector<Double3> read_rows(hid_t file, const std::string& path, const char* name,
                               std::size_t available) {
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
  must_fit(where, 2 * dims[0] * sizeof(Double3), available);  // positions and velocities
  std::vector<Double3> out(dims[0]);
  if (dims[0] > 0)
    h5::check(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()));
  for (std::size_t i = 0; i < out.size(); ++i)
    for (double value : out[i])
      if (!std::isfinite(value)) bad_input(where, "row " + std::to_string(i) + " is not finite");
  return out;
}

Particles read_hdf5(const std::string& path, const std::string& bytes, std::size_t available) {
  try {
    const h5::Reading file(path, bytes);
    Particles p;
    if (!h5::has_link(file, "position"))
      bad_input(path + ": dataset position", "is missing; a particle file needs position (N, 3)");
    p.position = read_rows(file, path, "position", available);
    if (h5::has_link(file, "velocity")) p.velocity = read_rows(file, path, "velocity", available);
    if (!h5::has_link(file, "velocity")) p.velocity.resize(p.size());
    if (p.velocity.size() != p.size())
      bad_input(path, "position has " + std::to_string(p.size()) + " rows, velocity " +
                          std::to_string(p.velocity.size()) + "; they must agree");
    return p;
  } catch (const h5::Failure& f) {
    throw Error(ExitCode::io, path + ": cannot be read as a particle file: " + f.what());
  }
}

/// All bytes from the present one on.
std::string bytes_of(RegularFile& file, std::size_t expected) {
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  std::string bytes;
  bytes.reserve(expected + kBlock);  // to grow takes twice the bytes for a moment
  for (std::size_t n = 1, at = 0; n > 0; at += n) {
    bytes.resize(at + kBlock);
    n = file.read(bytes.data() + at, kBlock);
    bytes.resize(at + n);
  }
  return bytes;
}

}  // namespace

Particles read_particle_file(const std::string& path, std::string* sha256) {
  note_input(path);
  RegularFile file(path, "a particle file (CSV or HDF5)",
                   "; paths of file bodies are relative to the folder of the scene file");
  const auto stamp = file.stamp();
  const std::size_t size = stamp.first, memory = available_memory();
  const std::size_t available = memory > 0 ? memory : ~std::size_t{0};
  char head[8];
  const std::size_t n = file.read(head, sizeof head);
  file.rewind();
  Sha256 hash;
  Particles p;
  if (h5::is_signature({head, n})) {
    must_fit(path, size, available);
    const std::string bytes = bytes_of(file, size);
    if (file.stamp() != stamp)
      throw Error(ExitCode::io, path +
                                    ": cannot be read as a particle file: it was written to while "
                                    "it was read; wait until it is whole");
    if (sha256) hash.add(bytes);
    const auto read = [&] {
      return read_hdf5(path, bytes, available - std::min(available, bytes.size()));
    };
    h5::trial(path, read);
    p = read();
  } else {
    must_fit(path, 2 * size, available);
    p = read_particle_csv(file, path, sha256 ? &hash : nullptr);
  }
  if (sha256) *sha256 = hash.text();
  return p;
}

}  // namespace pbf::io_module
