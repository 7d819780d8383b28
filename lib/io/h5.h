// HDF5's C API with owning handles, one lock for the process, and errors as exceptions.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pbf::io_module::h5 {

/// Held around every use of HDF5: the distributions build the library without thread safety. Not
/// recursive. check() and every handle below end with Error(internal) where a thread has forgotten
/// it. Files that are read come with it: h5::Reading, lib/io/h5_read.h. Also sets what HDF5 must
/// not do by itself: print its error stack, clean up at exit (which cannot end well for a file on a
/// full disk; every handle here is closed by its owner), load plugins, go into other files.
class Lock {
 public:
  Lock();
  ~Lock();
  static bool held();  ///< by this thread

 private:
  std::unique_lock<std::mutex> lock_;
};

/// Gives the Lock of this thread, if it has it, to others during its lifetime, for what takes long
/// and is none of HDF5's: waiting for the disk.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;

 private:
  const bool held_ = Lock::held();
};

/// The reason of the last failed HDF5 call of this thread, as short as it can be said: the
/// operating system's message ("No space left on device") if there is one.
std::string reason();

/// Thrown by the helpers below when an HDF5 call fails; what() is the reason. Callers add the file
/// and what they were doing, and throw pbf::Error.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Error(internal) when this thread does not hold the Lock.
void require_lock();

/// `id` itself, or Failure when it is negative: HDF5's way to report an error.
template <class Id>
Id check(Id id) {
  require_lock();
  if (id < 0) throw Failure(reason());
  return id;
}

/// Owns one HDF5 id; closes it with `Close`, under a Lock of its own where none is held.
template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(check(id)) {}  // takes the result of H5Xopen or H5Xcreate
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() { reset(); }
  /// Closes; the result tells whether that worked (a file: whether all of it reached the system).
  bool reset() noexcept {
    if (id_ < 0) return true;
    std::optional<Lock> lock;
    if (!Lock::held()) lock.emplace();
    return Close(std::exchange(id_, -1)) >= 0;
  }
  operator hid_t() const { return id_; }
  bool open() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;
using Object = Handle<H5Oclose>;

/// The memory type of a C++ scalar.
template <class T>
hid_t native() {
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
}

/// File access for run files: no file locks, so that a live file can be read.
Properties file_access();
/// The type of strings in memory and in the file: variable length, UTF-8 (h5py reads str).
Type string_type();

Group make_group(hid_t parent, const char* name);
void write_text(hid_t object, const char* name, const std::string& value);
void write_texts(hid_t object, const char* name, const std::vector<std::string>& values);
/// A fixed-length ASCII attribute, for readers that accept nothing else (VTK).
void write_ascii(hid_t object, const char* name, const std::string& value);

/// A new attribute of `count` values, or of one (none).
Attribute make_attribute(hid_t object, const char* name, hid_t type,
                         std::optional<hsize_t> count = {});
/// Writes `values` as a scalar (count 0) or one-dimensional attribute; replaces nothing.
template <class T>
void write_numbers(hid_t object, const char* name, const T* values, hsize_t count = 0) {
  const auto size = count ? std::optional(count) : std::nullopt;
  check(H5Awrite(make_attribute(object, name, native<T>(), size), native<T>(), values));
}

template <class T>
void write_number(hid_t object, const char* name, T value) {
  write_numbers(object, name, &value);
}

/// Makes a dataset of `shape` (none: one value) from `values` of memory type `from`.
void write_dataset(hid_t parent, const char* name, hid_t type, const std::vector<hsize_t>& shape,
                   hid_t from, const void* values, const char* unit, hid_t create = H5P_DEFAULT);

/// The descriptor behind an open file; it stays HDF5's.
int descriptor(hid_t file);

bool has_attribute(hid_t object, const char* name);
bool has_link(hid_t group, const std::string& path);  ///< every part of the path is looked at
/// A one-dimensional dataset of texts of `size` bytes, padded with zeros.
std::vector<std::string> read_fixed_texts(hid_t group, const std::string& path, std::size_t size);
std::string read_text(hid_t object, const char* name);
std::vector<std::string> read_texts(hid_t object, const char* name);
/// The numbers in an attribute of at most 64, converted to T.
template <class T>
std::vector<T> read_numbers(hid_t object, const char* name) {
  const Attribute a(H5Aopen(object, name, H5P_DEFAULT));
  const auto count = check(H5Sget_simple_extent_npoints(Space(H5Aget_space(a))));
  if (count > 64) throw Failure(std::string("attribute ") + name + " has too many numbers");
  std::vector<T> values(static_cast<std::size_t>(count));
  if (!values.empty()) check(H5Aread(a, native<T>(), values.data()));
  return values;
}
template <class T>
T read_number(hid_t object, const char* name) {
  const auto values = read_numbers<T>(object, name);
  if (values.size() != 1) throw Failure(std::string("attribute ") + name + " is not one number");
  return values[0];
}
/// A group, or a dataset, of an open file by its path. Both follow hard links and soft links within
/// the file. Failure for what leads out of it: external and user-defined links, external storage
/// and virtual datasets, which let a file from elsewhere take in any file of this machine. A
/// dataset whose chunks claim more than the file can hold is a Failure too.
Group open_group(hid_t parent, const std::string& path);
Dataset open_dataset(hid_t parent, const std::string& path);
std::vector<hsize_t> shape(hid_t dataset);
/// Number of values in a block of a dataset, `size` bytes each in memory. Failure, before memory is
/// taken for them, when they are more than the file can hold: deflate makes 1 byte of at most 1032.
std::size_t claimed(hid_t dataset, const std::vector<hsize_t>& block, std::size_t size);
/// Reads a block that begins at row `first` into memory of type `type`.
void read_block(hid_t dataset, hsize_t first, const std::vector<hsize_t>& block, hid_t type,
                void* values);
/// The first rows (all, or at most `rows`) of a dataset, converted to T, row by row.
template <class T>
std::vector<T> read_all(hid_t group, const std::string& path, hsize_t rows = ~hsize_t{0}) {
  const Dataset d = open_dataset(group, path);
  std::vector<hsize_t> count = shape(d);
  if (!count.empty() && rows < count[0]) count[0] = rows;
  std::vector<T> values(claimed(d, count, sizeof(T)));
  if (!values.empty()) read_block(d, 0, count, native<T>(), values.data());
  return values;
}

/// Names of the datasets (or of the groups) directly in a group, in alphabetical order.
std::vector<std::string> children(hid_t group, H5O_type_t kind);
/// Paths of the datasets in a group and in so many groups one in the other: "stage/lambda".
std::vector<std::string> datasets_below(hid_t group, int groups);

}  // namespace pbf::io_module::h5
