// Opens HDF5 files of unknown origin for reading.
#pragma once

#include <string>

#include "lib/io/h5.h"

namespace pbf::io_module::h5 {

/// A file open for reading, with the lock that every use of it needs: who has the file has the
/// lock, so that neither can be forgotten. Failure with the reason when it cannot be opened or is
/// no regular file (one that HDF5 would wait for without end, say). What is in it is reached by
/// open_group() and open_dataset().
class Reading {
 public:
  explicit Reading(const std::string& path);
  /// The bytes of a file, which must outlive this; `path` is for messages. Nothing is opened.
  Reading(const std::string& path, const std::string& bytes);
  operator hid_t() const { return file_; }

 private:
  Lock lock_;  // first: released last
  File file_;
};

/// Failure for a path that leaves the file: see open_group(). Paths that lead nowhere are left to
/// whoever opens them.
void stay_inside(hid_t parent, const std::string& path);

}  // namespace pbf::io_module::h5
