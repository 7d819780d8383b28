// Tries HDF5 files of unknown origin first. On some damaged files HDF5 1.10.8 loops for ever,
// requests huge amounts of memory, or reads beyond a chunk that is shorter than the dataset says
// (fuzzing found it in H5Dread). Most of these cases end in an error of HDF5, some in a crash.
#pragma once

#include <functional>
#include <string>

namespace pbf::io_module::h5 {

/// Lets a child process do `action` (which reads the file at `path`) first, so that a file on which
/// HDF5 crashes, or goes on for more than `seconds` of CPU time, is an Error(io) here and not the
/// end of the program. Errors that the action throws are left to whoever does it next. Not to be
/// called under a Lock.
void trial(const std::string& path, const std::function<void()>& action, unsigned seconds = 60);

}  // namespace pbf::io_module::h5
