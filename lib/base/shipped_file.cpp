#include "lib/base/shipped_file.h"

#include <filesystem>

namespace pbf::base_module {

std::string shipped_file(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(name, error)) return name;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return name;
  for (const fs::path& place : {folder, folder / "..", folder / "../share/pbf"})
    if (const fs::path path = (place / name).lexically_normal(); fs::exists(path, error))
      return path.string();
  return name;
}

}  // namespace pbf::base_module
