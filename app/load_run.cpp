#include "app/load_run.h"

#include <filesystem>
#include <fstream>

#include "lib/io/h5_trial.h"
#include "lib/io/run_file.h"

namespace pbf {
namespace {

bool is_hdf5(const std::string& path) {
  // Anything else, a pipe say, can be read once: the scene's reader must find it whole.
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream in(path, std::ios::binary);
  return h5::begins_as_hdf5(in);
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
