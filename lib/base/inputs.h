// The files that a command has read. No output of the command may replace one of them.
#pragma once

#include <string>
#include <vector>

namespace pbf::base_module {

/// Call this for every file that the user named (on the command line or in another file) and that
/// is read.
void note_input(const std::string& path);

/// The noted files, in alphabetical order.
std::vector<std::string> inputs();
/// The noted file that is the same (device and inode) as `path`; empty if there is none. Pipes and
/// devices never match: a command may read and write them.
std::string input_at(const std::string& path);

}  // namespace pbf::base_module
