#include "lib/io/particle_file.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/machine.h"
#include "lib/base/own_file.h"
#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"
#include "lib/base/text.h"
#include "lib/io/csv.h"
#include "lib/io/h5_read.h"

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

constexpr const char* kNames[] = {"x", "y", "z", "vx", "vy", "vz"};
constexpr std::size_t kLongestLine = 4096;  // bytes; six numbers need a few hundred
constexpr const char* kExpected = "expected x,y,z or x,y,z,vx,vy,vz";

bool printable(std::string_view s) {
  return std::ranges::all_of(s, [](char c) { return c >= ' ' && c <= '~'; });
}

/// The header without blanks; tells how many columns follow.
int csv_columns(std::string_view line, const std::string& where) {
  std::string header;
  for (char c : trimmed(line))
    if (c != ' ' && c != '\t') header += c;
  header = std::string(without_mark(header));
  if (header == "x,y,z") return 3;
  if (header == "x,y,z,vx,vy,vz") return 6;
  bad_input(where, wrong_header(header) + ", " + kExpected);
}

void parse_row(std::string_view line, int columns, const CsvLines& lines, double* row) {
  int column = 0;
  for (std::string_view rest = line;; ++column) {
    const std::size_t comma = rest.find(',');
    const std::string_view cell = trimmed(rest.substr(0, comma));
    if (column < columns) {
      std::string_view digits = cell;
      if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
      const char* end = digits.data() + digits.size();
      const auto [stop, ec] = std::from_chars(digits.data(), end, row[column]);
      const auto refuse = [&](const char* what) {
        const std::string value = printable(cell)
                                      ? std::string("\"").append(cell.substr(0, 40)) + "\""
                                      : "what stands there, no plain text,";
        bad_input(lines.where(), std::string(kNames[column]) + ": " + value + what);
      };
      if (cell.empty())
        bad_input(lines.where(), std::string(kNames[column]) + ": empty, expected a number");
      if (ec == std::errc::result_out_of_range) refuse(" does not fit a double");
      if (ec != std::errc{} || stop != end) refuse(" is not a number");
      if (!std::isfinite(row[column])) refuse(" is not finite");
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (column + 1 != columns)
    bad_input(lines.where(),
              std::to_string(column + 1) + " columns, the header has " + std::to_string(columns));
}

/// No message shows a line of a file that has not begun as a particle file does: a scene from
/// elsewhere may name any file of this machine.
Particles read_csv_file(RegularFile& file, const std::string& path, Sha256* hash) {
  CsvLines lines(file, path, {hash, kLongestLine, kExpected});
  int columns = 0;
  Particles p;
  for (std::string line; lines.next(line);) {
    if (trimmed(line).empty()) continue;
    if (columns == 0) {
      columns = csv_columns(line, lines.where());
      continue;
    }
    double row[6] = {};
    parse_row(line, columns, lines, row);
    p.position.push_back({row[0], row[1], row[2]});
    p.velocity.push_back({row[3], row[4], row[5]});
  }
  if (columns == 0)
    bad_input(path, "empty, expected a header x,y,z or x,y,z,vx,vy,vz and particles");
  return p;
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
    p = read_csv_file(file, path, sha256 ? &hash : nullptr);
  }
  if (sha256) *sha256 = hash.text();
  return p;
}

void write_particle_file(const std::string& path, const Particles& particles) {
  require_own_file(path);
  ::unlink(path.c_str());
  const h5::Lock lock;
  try {
    h5::File file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT));
    const auto write = [&](const char* name, const char* unit, const std::vector<Double3>& rows) {
      h5::write_dataset(file, name, H5T_IEEE_F64LE, {rows.size(), 3}, H5T_NATIVE_DOUBLE,
                        rows.data(), unit);
    };
    write("position", "m", particles.position);
    write("velocity", "m/s", particles.velocity);
    if (!file.reset()) throw h5::Failure(h5::reason());
  } catch (const h5::Failure& e) {
    throw Error(ExitCode::io, path + ": cannot be written: " + e.what());
  }
}

}  // namespace pbf::io_module
