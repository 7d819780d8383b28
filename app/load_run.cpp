#include "app/load_run.h"

#include <cstring>
#include <filesystem>
#include <fstream>

#include "lib/io/run_file.h"

namespace pbf {
namespace {

bool is_hdf5(const std::string& path) {
  constexpr char kSignature[] = "\x89HDF\r\n\x1a\n";
  // Anything else, a pipe say, can be read once: the scene's reader must find it whole.
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream in(path, std::ios::binary);
  char head[8] = {};
  in.read(head, sizeof head);
  return in.gcount() == sizeof head && std::memcmp(head, kSignature, sizeof head) == 0;
}

}  // namespace

LoadedScene load_scene_or_run(const std::string& path, const std::vector<std::string>& overrides) {
  if (!is_hdf5(path)) return load_scene(path, overrides);
  try_run_file(path);
  const RunInfo info = RunReader(path).info();
  LoadedScene loaded;
  loaded.scene = parse_scene(info.resolved_scene, path + ": its scene", overrides);
  loaded.path = info.scene_path;
  loaded.text = info.scene_text;
  loaded.overrides = info.overrides;
  loaded.overrides.insert(loaded.overrides.end(), overrides.begin(), overrides.end());
  return loaded;
}

}  // namespace pbf
