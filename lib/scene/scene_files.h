// The files that a scene names, as they were read: what a run file and a checkpoint keep of them.
#pragma once

#include <string>
#include <vector>

namespace pbf::inline scene_module {

struct SceneFile {
  std::string path;    ///< as the scene has it
  std::string sha256;  ///< of the bytes that were read
};

/// One line per file, as sha256sum writes and checks them: "digest  path\n". Empty without files.
std::string files_text(const std::vector<SceneFile>& files);

/// What ties a scene and its files together in a run file and a checkpoint: SHA-256 of both texts,
/// one after the other.
std::string scene_digest(const std::string& resolved_scene, const std::string& files);

/// What has changed of the files that both name: `before` a files_text(); "p.csv: its contents have
/// changed: SHA-256 ... before, ... now", empty when nothing has.
std::string files_difference(const std::string& before, const std::vector<SceneFile>& now);

}  // namespace pbf::inline scene_module
