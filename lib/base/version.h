// Describes this build: version, commit, compiler, features, libraries.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pbf::base_module {

struct BuildInfo {
  std::string version;   ///< of the program, "0.1.0"
  std::string commit;    ///< ends in "+changes" if the sources differ; "unknown" without git
  std::string type;      ///< Release, RelWithDebInfo, Debug
  std::string compiler;  ///< name and version
  std::string flags;     ///< of the C++ compiler
  std::string features;  ///< separated by blanks: openmp render cuda
  std::vector<std::pair<std::string, std::string>> libraries;  ///< name, version built against
};

BuildInfo build_info();

}  // namespace pbf::base_module
