#include "lib/run/load_run.h"

#include <filesystem>

#include "lib/base/error.h"
#include "lib/io/run_file.h"
#include "lib/io/run_path.h"
#include "lib/run/emit.h"
#include "lib/run/linked_files.h"

namespace pbf::run_module {
namespace fs = std::filesystem;

std::string folder_of_files(const Scene& scene, const std::string& run_file,
                            const std::string& scene_path) {
  const std::string then = fs::path(scene_path).parent_path().string();
  const std::string beside = fs::path(run_file).parent_path().string();
  const auto missing = [&](const std::string& folder) {
    std::error_code error;
    for (const Body& b : scene.bodies)
      if (b.from_file() && !fs::exists(fs::path(folder) / b.path, error)) return b.path;
    for (const std::string& path : linked_paths(scene))
      if (!fs::exists(fs::path(folder) / path, error)) return path;
    for (const Comparison& c : scene.compare)
      if (!fs::exists(fs::path(folder) / c.data, error)) return c.data;
    return std::string();
  };
  const std::string file = missing(then);
  if (file.empty()) return then;
  if (missing(beside).empty()) return beside;
  const auto name = [](const std::string& folder) { return folder.empty() ? "." : folder; };
  bad_input(run_file, "its file " + file + " is neither in " + name(then) +
                          ", the folder of its scene file, nor in " + name(beside) +
                          ", its own; put it into one of them, or name it with --set "
                          "bodies.0.path=PATH (0: the number of the body)");
}

LoadedScene load_scene_or_run(const std::string& given, const std::vector<std::string>& overrides,
                              const std::string& base_folder) {
  std::error_code error;
  const bool folder = fs::is_directory(given, error);  // a run folder; it is no scene file
  const std::string path = folder ? only_run_path(given) : given;
  if (!folder && !is_hdf5_file(path)) {
    LoadedScene loaded = load_scene(path, overrides, base_folder);
    read_linked_files(loaded.scene, loaded.folder, loaded.auto_step);
    return loaded;
  }
  try_run_file(path);
  const RunInfo info = RunReader(path).info();
  if (!info.scene_sha256.empty() &&
      info.scene_sha256 != scene_digest(info.resolved_scene, info.scene_files))
    bad_input(
        path,
        "the scene in it (/pbf resolved_scene, scene_files) has been changed since the run: "
        "its SHA-256 is not /pbf scene_sha256; give the scene file itself, or the run file as "
        "it was");
  LoadedScene loaded;
  loaded.scene = parse_stored_scene(info.resolved_scene, path + ": its scene", overrides);
  loaded.path = info.scene_path;
  loaded.text = info.scene_text;
  loaded.bases = info.scene_bases;
  loaded.folder = folder_of_files(loaded.scene, path, info.scene_path);
  read_linked_files(loaded.scene, loaded.folder);
  loaded.run_file = path;
  loaded.files = info.scene_files;
  loaded.files_known = !info.scene_sha256.empty();
  loaded.overrides = info.overrides;
  loaded.overrides.insert(loaded.overrides.end(), overrides.begin(), overrides.end());
  return loaded;
}

void read_files_of_run(Scene& scene, const std::string& run_file, const std::string& scene_path) {
  Scene solids = scene;
  solids.bodies.clear();
  read_linked_files(
      scene, linked_paths(scene).empty() ? "" : folder_of_files(solids, run_file, scene_path));
}

void take_files(LoadedScene& loaded, const std::vector<SceneFile>& read,
                std::vector<std::string>& notes) {
  if (!loaded.run_file.empty() && !read.empty()) {
    if (!loaded.files_known)
      notes.push_back(loaded.run_file +
                      " is of an earlier version, which kept no SHA-256 of its particle files: "
                      "they are taken as they are");
    const std::string difference = files_difference(loaded.files, read);
    if (!difference.empty())
      bad_input(loaded.run_file,
                "cannot run again: " + difference + " (read from the folder " +
                    (loaded.folder.empty() ? "." : loaded.folder) +
                    "); put the file of the run there, or give the scene file itself to run with "
                    "the new one");
  }
  loaded.files = files_text(read);
}

}  // namespace pbf::run_module
