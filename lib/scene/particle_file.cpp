#include "lib/scene/particle_file.h"

#include <hdf5.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "lib/base/error.h"
#include "lib/io/h5_trial.h"

namespace pbf {
namespace {

[[noreturn]] void bad(const std::string& where, const std::string& what) {
  throw Error(ExitCode::bad_input, where + ": " + what);
}

/// Opens for reading; Error(io) with the system's reason.
std::ifstream open_file(const std::string& path) {
  std::error_code ec;
  if (std::filesystem::is_directory(path, ec))
    throw Error(ExitCode::io, path + ": is a directory, expected a particle file (CSV or HDF5)");
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw Error(ExitCode::io,
                path + ": cannot be opened: " + std::string(std::strerror(errno)) +
                    "; paths of file bodies are relative to the folder of the scene file");
  return in;
}

bool is_hdf5(const std::string& path) {
  std::ifstream in = open_file(path);
  return h5::begins_as_hdf5(in);
}

// ---- CSV

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
    s.remove_suffix(1);
  return s;
}

/// The header without blanks; tells how many columns follow.
int csv_columns(std::string_view line, const std::string& where) {
  std::string header;
  for (char c : trimmed(line))
    if (c != ' ' && c != '\t') header += c;
  if (header.rfind("\xEF\xBB\xBF", 0) == 0) header.erase(0, 3);  // byte order mark of spreadsheets
  if (header == "x,y,z") return 3;
  if (header == "x,y,z,vx,vy,vz") return 6;
  if (header.size() > 60) header = header.substr(0, 60) + "...";
  for (char& c : header)
    if (static_cast<unsigned char>(c) < 32) c = '?';
  bad(where, "the header is \"" + header + "\", expected x,y,z or x,y,z,vx,vy,vz");
}

void parse_row(std::string_view line, int columns, const std::string& where, double* row) {
  static constexpr const char* kNames[] = {"x", "y", "z", "vx", "vy", "vz"};
  int column = 0;
  for (std::string_view rest = line;; ++column) {
    const std::size_t comma = rest.find(',');
    const std::string_view cell = trimmed(rest.substr(0, comma));
    if (column < columns) {
      std::string_view digits = cell;
      if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
      const char* end = digits.data() + digits.size();
      const auto [stop, ec] = std::from_chars(digits.data(), end, row[column]);
      const std::string value = std::string("\"").append(cell.substr(0, 40)) + "\"";
      if (cell.empty()) bad(where, std::string(kNames[column]) + ": empty, expected a number");
      if (ec == std::errc::result_out_of_range)
        bad(where, std::string(kNames[column]) + ": " + value + " does not fit a double");
      if (ec != std::errc{} || stop != end)
        bad(where, std::string(kNames[column]) + ": " + value + " is not a number");
      if (!std::isfinite(row[column]))
        bad(where, std::string(kNames[column]) + ": " + value + " is not finite");
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (column + 1 != columns)
    bad(where, std::to_string(column + 1) + " columns, the header has " + std::to_string(columns));
}

/// Calls `use(line, columns, where)` for every data line.
template <class Use>
void for_each_csv_row(const std::string& path, Use use) {
  std::ifstream in = open_file(path);
  std::string line;
  int columns = 0;
  for (std::int64_t number = 1; std::getline(in, line); ++number) {
    if (trimmed(line).empty()) continue;
    const std::string where = path + ":" + std::to_string(number);
    if (columns == 0)
      columns = csv_columns(line, where);
    else
      use(std::string_view(line), columns, where);
  }
  if (in.bad()) throw Error(ExitCode::io, path + ": reading failed");
  if (columns == 0) bad(path, "empty, expected a header x,y,z or x,y,z,vx,vy,vz and particles");
}

// ---- HDF5

/// Owns an HDF5 identifier.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  bool ok() const { return id_ >= 0; }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its error stack by itself; our messages say what matters. Restored at the end.
class QuietHdf5 {
 public:
  QuietHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Rows of dataset `name`, which must be (N, 3) numbers; fills `out` when given.
std::int64_t read_rows(hid_t file, const std::string& path, const char* name,
                       std::vector<Double3>* out) {
  const std::string where = path + ": dataset " + name;
  const Handle data(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  if (!data.ok()) bad(where, "is missing or no dataset; a particle file needs position (N, 3)");
  const Handle type(H5Dget_type(data), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) bad(where, "does not hold numbers");
  const Handle space(H5Dget_space(data), H5Sclose);
  hsize_t dims[2] = {};
  if (H5Sget_simple_extent_ndims(space) != 2) bad(where, "has the wrong rank, expected (N, 3)");
  H5Sget_simple_extent_dims(space, dims, nullptr);
  if (dims[1] != 3) bad(where, "has " + std::to_string(dims[1]) + " columns, expected 3: x, y, z");
  if (dims[0] > 2147483647u)
    bad(where, "has " + std::to_string(dims[0]) + " rows; at most 2147483647 particles fit");
  hsize_t bytes = 0;  // compression makes at most 1032 of 1
  if (H5Fget_filesize(file, &bytes) < 0 || dims[0] / 1032 > bytes)
    bad(where,
        "claims " + std::to_string(dims[0]) + " rows, more than the file can hold; it is damaged");
  if (out != nullptr) {
    out->resize(dims[0]);
    if (dims[0] > 0 &&
        H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out->data()) < 0)
      throw Error(ExitCode::io, where + ": reading failed; the file may be cut off");
    for (std::size_t i = 0; i < out->size(); ++i)
      for (double value : (*out)[i])
        if (!std::isfinite(value)) bad(where, "row " + std::to_string(i) + " is not finite");
  }
  return static_cast<std::int64_t>(dims[0]);
}

/// Reads into `out` when given; returns the number of particles.
std::int64_t read_hdf5(const std::string& path, Particles* out) {
  const QuietHdf5 quiet;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok()) throw Error(ExitCode::io, path + ": HDF5 cannot open it; it may be cut off");
  const auto count = read_rows(file, path, "position", out ? &out->position : nullptr);
  if (H5Lexists(file, "velocity", H5P_DEFAULT) > 0) {
    const auto rows = read_rows(file, path, "velocity", out ? &out->velocity : nullptr);
    if (rows != count)
      bad(path, "position has " + std::to_string(count) + " rows, velocity " +
                    std::to_string(rows) + "; they must agree");
  } else if (out != nullptr) {
    out->velocity.assign(static_cast<std::size_t>(count), Double3{});
  }
  return count;
}

}  // namespace

Particles read_particle_file(const std::string& path) {
  Particles p;
  if (is_hdf5(path)) {
    read_hdf5(path, &p);
    return p;
  }
  for_each_csv_row(path, [&p](std::string_view line, int columns, const std::string& where) {
    double row[6] = {};
    parse_row(line, columns, where, row);
    p.position.push_back({row[0], row[1], row[2]});
    p.velocity.push_back({row[3], row[4], row[5]});
  });
  return p;
}

std::int64_t count_particle_file(const std::string& path) {
  if (is_hdf5(path)) {
    h5::trial(path, [&path] {
      Particles p;
      read_hdf5(path, &p);
    });
    return read_hdf5(path, nullptr);
  }
  std::int64_t count = 0;
  for_each_csv_row(path, [&count](std::string_view, int, const std::string&) { ++count; });
  return count;
}

}  // namespace pbf
