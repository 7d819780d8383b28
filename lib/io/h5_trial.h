// HDF5 files from elsewhere. On some damaged bytes HDF5 1.10.8 goes on for ever, asks for memory
// without measure, or reads beyond a chunk that is shorter than the dataset says (fuzzing found it
// in H5Dread); most of that ends in its own errors, some in a crash.
#pragma once

#include <functional>
#include <string>

namespace pbf::inline io_module::h5 {

/// Lets a child process do `action` (which reads the file at `path`) first, so that a file on which
/// HDF5 crashes, or goes on for more than `seconds` of CPU time, is an Error(io) here and not the
/// end of the program. Errors that the action throws are left to whoever does it next. Not to be
/// called under a Lock.
void trial(const std::string& path, const std::function<void()>& action, unsigned seconds = 60);

}  // namespace pbf::inline io_module::h5
