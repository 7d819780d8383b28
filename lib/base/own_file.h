// Files that the program names itself, in a folder of results: never links, FIFOs or devices.
#pragma once

#include <string>

namespace pbf::base_module {

/// Throws Error(io) if the path exists and is not a regular file. Links are refused because their
/// target may lie outside of the folder.
void require_own_file(const std::string& path);

/// Opens such a file without following a link and without waiting. `flags`: O_WRONLY | O_CREAT ...
/// The caller closes the descriptor. Throws Error(io).
int open_own_file(const std::string& path, int flags);

}  // namespace pbf::base_module
