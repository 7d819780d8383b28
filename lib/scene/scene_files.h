// Record of the files that a scene names, as they were read, for run files and checkpoints.
#pragma once

#include <string>
#include <vector>

namespace pbf::scene_module {

struct SceneFile {
  std::string path;    ///< as written in the scene
  std::string sha256;  ///< of the bytes that were read
};

/// One line per file, as sha256sum writes and checks them: "digest  path\n". Empty without files.
std::string files_text(const std::vector<SceneFile>& files);

/// Identifies a scene with its files in a run file and a checkpoint: SHA-256 of both texts, one
/// after the other.
std::string scene_digest(const std::string& resolved_scene, const std::string& files);

/// Differences between files that both sides name; `before`: a files_text(). "p.csv: its contents
/// have changed: SHA-256 ... before, ... now"; empty if there is none.
std::string files_difference(const std::string& before, const std::vector<SceneFile>& now);

}  // namespace pbf::scene_module
