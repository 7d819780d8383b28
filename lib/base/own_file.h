// Files in a folder of results that the program names itself: never links, FIFOs or devices.
#pragma once

#include <string>

namespace pbf::inline base_module {

/// For files that the program names itself, in a folder of results. Throws Error(io) when something
/// else than a regular file is there; a link too, for its target is nobody's result.
void require_own_file(const std::string& path);

/// Opens such a file, without following a link and without waiting. `flags`: O_WRONLY | O_CREAT ...
/// The descriptor is the caller's. Throws Error(io).
int open_own_file(const std::string& path, int flags);

}  // namespace pbf::inline base_module
