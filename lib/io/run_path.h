// Where the file of a run is: whatever reads a run takes its file or its folder.
#pragma once

#include <string>

namespace pbf::io_module {

/// Beside the run file: the scene with every default.
inline constexpr const char* kResolvedScene = "scene.resolved.yaml";

/// The run file that a path names: of a folder run.vtkhdf in it, else the path itself, be there a
/// file or not. Error(bad_input) for a folder without one, which says what it holds instead.
std::string run_path(const std::string& path);

/// Whether a regular file begins as HDF5 does. Anything else, a pipe say, is not touched: it can be
/// read once.
bool is_hdf5_file(const std::string& path);

/// run_path() for a command that takes nothing but runs: Error(io) for a file that is not HDF5,
/// which says of a scene how to run it.
std::string only_run_path(const std::string& path);

/// The folder of a run that `run_file` is the file of, with its scene beside it; empty: it is a
/// file by itself, a copy say.
std::string folder_of_run(const std::string& run_file);

}  // namespace pbf::io_module
