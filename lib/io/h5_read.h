// Opens HDF5 files of unknown origin for reading.
#pragma once

#include <functional>
#include <string>
#include <string_view>

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

/// Whether the first 8 bytes of a file are HDF5's signature.
inline bool is_signature(std::string_view head) { return head == "\x89HDF\r\n\x1a\n"; }

/// Lets a child process do `action` (which reads the file at `path`) first, so that a file on which
/// HDF5 crashes, or goes on for more than `seconds` of CPU time, is an Error(io) here and not the
/// end of the program. On some damaged files HDF5 1.10.8 loops for ever, requests huge amounts of
/// memory, or reads beyond a chunk that is shorter than the dataset says (fuzzing found it in
/// H5Dread). Errors that the action throws are left to whoever does it next. Not to be called under
/// a Lock.
void trial(const std::string& path, const std::function<void()>& action, unsigned seconds = 60);

/// Failure for a path that leaves the file: see open_group(). Paths that lead nowhere are left to
/// whoever opens them.
void stay_inside(hid_t parent, const std::string& path);

}  // namespace pbf::io_module::h5
