#include "lib/scene/scene_files.h"

#include <sstream>

#include "lib/base/sha256.h"
#include "lib/scene/difference.h"

namespace pbf::scene_module {
namespace {

/// As sha256sum does: special characters of the path are escaped, and a backslash precedes the
/// digest.
std::string line_of(const SceneFile& file) {
  std::string path;
  for (const char c : file.path)
    path += c == '\\' ? "\\\\" : c == '\n' ? "\\n" : c == '\r' ? "\\r" : std::string(1, c);
  return (path == file.path ? "" : "\\") + file.sha256 + "  " + path;
}

}  // namespace

std::string files_text(const std::vector<SceneFile>& files) {
  std::string text;
  for (const SceneFile& f : files) text += line_of(f) + "\n";
  return text;
}

std::string scene_digest(const std::string& resolved_scene, const std::string& files) {
  return sha256(resolved_scene + files);
}

std::string files_difference(const std::string& before, const std::vector<SceneFile>& now) {
  std::vector<std::string> changed;
  for (const SceneFile& file : now) {
    const std::string wanted = line_of(file);
    const std::size_t digits = wanted.find("  ");
    std::string other;
    std::istringstream lines(before);
    for (std::string line; std::getline(lines, line) && other != wanted;)
      if (const std::size_t at = line.find("  ");
          at != std::string::npos && line.substr(at) == wanted.substr(digits))
        other = line;
    if (!other.empty() && other != wanted)
      changed.push_back(file.path + ": its contents have changed: SHA-256 " +
                        other.substr(0, other.find("  ")) + " before, " + wanted.substr(0, digits) +
                        " now");
  }
  return first_of(changed);
}

}  // namespace pbf::scene_module
