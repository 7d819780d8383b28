#include "lib/scene/file_kind.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <vector>

#include "lib/scene/base_scene.h"

namespace pbf::scene_module {
namespace {

struct FileKind {
  const char *name, *command;
  std::vector<const char*> keys;  ///< top-level keys, each of which only this kind has
};

const std::vector<FileKind>& kinds() {
  static const std::vector<FileKind> kKinds{
      {"scene", "pbf run", {"domain", "fluid", "bodies", kBaseKey}},
      {"study", "pbf study", {"scene"}},
      {"stability suite", "pbf stability --suite", {"cases"}}};
  return kKinds;
}

std::string taken_by(const std::string& what, const std::string& wanted, const std::string& command,
                     const std::string& path) {
  return "is a " + what + ", expected a " + wanted + "; " + command + " " + path + " takes it";
}

bool is_run(const std::string& line) {
  std::istringstream words(line);
  std::string scene, setting;
  words >> scene;
  if (!has_scene_name(scene) && !has_run_name(scene)) return false;
  while (words >> setting)
    if (setting.find('=') == std::string::npos) return false;
  return true;
}

}  // namespace

bool has_scene_name(const std::string& path) {
  const std::filesystem::path end = std::filesystem::path(path).extension();
  return end == ".yaml" || end == ".yml";
}

bool has_run_name(const std::string& path) {
  const std::filesystem::path end = std::filesystem::path(path).extension();
  return end == ".vtkhdf" || end == ".h5";
}

std::string other_text(const std::string& text, const std::string& path,
                       const std::string& wanted) {
  std::istringstream lines(text);
  bool any = false;
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (!is_run(line)) return "";
    any = true;
  }
  return any ? taken_by("list of runs", wanted, "pbf batch", path) : "";
}

std::string other_file(Node& root, const std::string& path, const std::string& wanted) {
  const auto has = [&](const FileKind& kind) {
    return std::ranges::any_of(kind.keys,
                               [&](const char* key) { return root.find(key) != nullptr; });
  };
  const auto named = [&](const FileKind& kind) { return kind.name == wanted; };
  const auto own = std::ranges::find_if(kinds(), named);
  if (own == kinds().end() || has(*own)) return "";
  for (const FileKind& kind : kinds())
    if (has(kind)) return taken_by(kind.name, wanted, kind.command, path);
  return "";
}

}  // namespace pbf::scene_module
