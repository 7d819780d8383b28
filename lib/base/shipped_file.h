// Files that come with the program: configs/ of the repository, of a bundle or of an installation.
#pragma once

#include <string>

namespace pbf::base_module {

/// The path of a file such as "configs/stability.yaml". Searched in this order: the working
/// directory, the folder of the program (a bundle), the folder above it (build/pbf), share/pbf in
/// that folder (an installation). If it is nowhere, the name itself: opening it gives the error.
std::string shipped_file(const std::string& name);

}  // namespace pbf::base_module
