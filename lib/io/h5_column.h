// Extensible datasets: one-dimensional columns that grow by appending, and arrays of frames.
#pragma once

#include <string>
#include <vector>

#include "lib/io/h5.h"
#include "lib/solver/snapshot.h"

namespace pbf::io_module::h5 {

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
};

/// A dataset whose first dimension grows. Rows are addressed by the caller; rows never written
/// hold anything. All members throw Failure.
class Column {
 public:
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
  hsize_t chunk_rows() const { return chunk_rows_; }
  bool open() const { return dataset_.open(); }
  /// Writes `count` rows of memory type `type` at row `first`; the dataset grows as needed.
  void write(hsize_t first, hsize_t count, hid_t type, const void* values);
  template <class T>
  void append(const std::vector<T>& values) {
    write(rows_, values.size() / static_cast<hsize_t>(components_ ? components_ : 1), native<T>(),
          values.data());
  }
  template <class T>
  void append(T value) {
    append(std::vector<T>{value});
  }

 private:
  Dataset dataset_;
  hsize_t rows_ = 0, chunk_rows_ = 0;
  int components_ = 0;
};

}  // namespace pbf::io_module::h5
