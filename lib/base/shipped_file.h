// Files that come with the program: configs/ of the repository, of a bundle or of an installation.
#pragma once

#include <string>

namespace pbf::inline base_module {

/// "configs/stability.yaml" where it is found first: in the working directory, beside the program
/// (a bundle), in the folder above it (build/pbf), in share/pbf there (an installation). The name
/// itself where it is nowhere, so that whoever opens it says what is missing.
std::string shipped_file(const std::string& name);

}  // namespace pbf::inline base_module
