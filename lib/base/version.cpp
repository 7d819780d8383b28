#include "lib/base/version.h"

#include "pbf_build_info.h"  // included only here: a new commit recompiles only this file

namespace pbf::base_module {

BuildInfo build_info() {
  BuildInfo info{PBF_VERSION,  PBF_COMMIT, PBF_BUILD_TYPE, PBF_COMPILER, PBF_BUILD_FLAGS,
                 PBF_FEATURES, {}};
  info.libraries = {{"HDF5", PBF_VERSION_HDF5},
                    {"yaml-cpp", PBF_VERSION_YAML_CPP},
                    {"CLI11", PBF_VERSION_CLI11},
                    {"nlohmann", PBF_VERSION_JSON},
                    {"fmt", PBF_VERSION_FMT}};
  if (*PBF_VERSION_PNG) info.libraries.emplace_back("libpng", PBF_VERSION_PNG);
  if (*PBF_VERSION_CUDART) info.libraries.emplace_back("cudart", PBF_VERSION_CUDART);
  return info;
}

}  // namespace pbf::base_module
