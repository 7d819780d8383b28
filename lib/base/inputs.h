// The files that a command has read. No output of the command may replace one of them.
#pragma once

#include <string>
#include <vector>

namespace pbf::inline base_module {

/// Called by whoever reads a file that the user has named, on the command line or in another file.
void note_input(const std::string& path);

/// All of them, in alphabetical order.
std::vector<std::string> inputs();

/// Which of them is the same file (device and inode) as `path`; empty: none. Pipes and devices may
/// be read and written.
std::string input_at(const std::string& path);

}  // namespace pbf::inline base_module
