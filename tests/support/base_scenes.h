// A folder with scene files that name each other, for the tests of `base:`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

/// Writes files and loads `my.yaml` among them.
struct Scenes {
  Folder folder;
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder.path / name).parent_path());
    return folder.write(name, text);
  }
  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  Scene scene(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    Scene s = load_scene(write("my.yaml", text), overrides).scene;
    if (s.name == "my") s.name = Scene{}.name;  // as one that was parsed
    return s;
  }
  std::string error(const std::string& text, const std::string& base_folder = "") const {
    return without(error_of([&] { load_scene(write("my.yaml", text), {}, base_folder); }));
  }
  /// Messages with the names of files alone.
  std::string without(std::string text) const {
    for (const std::string& name :
         {folder.path.string() + "/", std::filesystem::canonical(folder.path).string() + "/"})
      for (std::size_t at; (at = text.find(name)) != text.npos;) text.erase(at, name.size());
    return text;
  }
};

}  // namespace pbf::scene_test
