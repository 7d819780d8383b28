// Writes HDF5 files that survive a crash and a full disk, and datasets that grow in them. Callers
// must hold an h5::Lock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/io/h5.h"
#include "lib/solver/snapshot.h"

namespace pbf::io_module::h5 {

/// File access for writers. Rows go to the disk at once, so that a full disk is noticed before
/// anything refers to them; what refers to them stays in memory until a flush, so that the file is
/// as the last flush left it.
Properties writer_access();

/// The size of the file on the disk, bytes.
std::int64_t stored_size(hid_t file);
/// Makes sure that the disk has room for the file from byte `from` on, and that no later process
/// takes it for something else. Returns whether the file became longer. Failure with the system's
/// reason.
bool reserve(hid_t file, std::int64_t from);

/// Makes the file longer, so that the disk has room for `bytes` more than HDF5 uses. False if it
/// has not; then nothing is changed. HDF5 does not know of it: trim() ends the file where HDF5
/// does.
bool extend(hid_t file, std::int64_t bytes);
void trim(hid_t file);

/// Writes what HDF5 holds in memory; the size of the file in bytes. HDF5 goes on after a failed
/// write and would leave a file that refers to what is not there, so the space is made sure of
/// first: nothing can fail after that. longer: the file has become longer since it was stored.
/// Failure with the system's reason.
std::int64_t flush_reserved(hid_t file, bool longer = false);

/// Waits until the disk has stored the file's bytes and its size (fdatasync). Network file systems
/// and quotas report a full disk only here. Failure with the system's reason.
void sync(hid_t file);

/// The same for the names in a folder, which are not stored with the files. No error where the
/// file system has no such thing.
void sync_folder(const std::string& folder);

/// After a failure: HDF5 insists on writing what it still holds and can neither be told to forget
/// it nor end cleanly when it fails again (a full disk), so its descriptor is turned away from the
/// file. All that may follow is closing.
void abandon(hid_t file) noexcept;

/// The types of a snapshot's numbers, in memory and in files.
hid_t memory_type(ScalarType t);
hid_t file_type(ScalarType t);
/// Of what the dataset at `path` holds. Failure for a type that this program does not write.
ScalarType scalar_type(hid_t dataset, const std::string& path);

/// How a growing dataset is laid out and labelled.
struct Layout {
  hsize_t chunk_rows = 512;
  int components = 0;  ///< 0: one-dimensional; else rows of so many scalars
  bool gzip = false;   ///< shuffle + deflate level 1
  std::string unit;    ///< attribute "units" when not empty
  int groups = 0;      ///< 0: none; else a row is so many times so many scalars, with three axes
};

/// A dataset whose first dimension grows. Rows are addressed by the caller; rows never written
/// hold anything. All members throw Failure.
class Column {
 public:
  /// Of a row: a file of unknown origin that has more is refused.
  static constexpr hsize_t most_components = 64, most_groups = 4096;

  Column() = default;
  /// Creates `path` (with the groups on the way) under `parent`, empty, of the file type `type`.
  Column(hid_t parent, const std::string& path, hid_t type, const Layout& layout);
  /// Opens `path` as such a constructor has left it. Failure when it has another shape.
  static Column existing(hid_t parent, const std::string& path);
  /// Drops what lies behind the first `rows` rows. Failure when there are fewer.
  void truncate(hsize_t rows);
  /// Stores the rows of the last chunk and one behind the end, `chunk`, without the dataset
  /// reaching to it: grow() then adds it by nothing but a new size. For unfiltered columns of
  /// doubles.
  void write_ahead(const std::vector<double>& chunk);
  void grow(hsize_t rows);
  hsize_t rows() const { return rows_; }
  hsize_t width() const;                                    ///< numbers of a row
  const std::vector<hsize_t>& row() const { return row_; }  ///< its axes; empty: a number
  hsize_t chunk_rows() const { return chunk_rows_; }
  bool open() const { return dataset_.open(); }
  /// Writes `count` rows of memory type `type` at row `first`; the dataset grows as needed.
  void write(hsize_t first, hsize_t count, hid_t type, const void* values);
  /// Makes room for rows that others write: bytes from the start of the file to each chunk, from
  /// the chunk on that begins with row `first`. For columns without compression.
  std::vector<std::uint64_t> make_room(hsize_t first, hsize_t count);
  template <class T>
  void append(const std::vector<T>& values) {
    write(rows_, values.size() / width(), native<T>(), values.data());
  }
  template <class T>
  void append(T value) {
    append(std::vector<T>{value});
  }

 private:
  /// So many rows, as the shape of a dataset.
  std::vector<hsize_t> shape_of(hsize_t rows) const;

  Dataset dataset_;
  hsize_t rows_ = 0, chunk_rows_ = 0;
  std::vector<hsize_t> row_;
};

}  // namespace pbf::io_module::h5
