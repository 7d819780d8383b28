// `base: other.yaml` at the top of a scene file: the scene is that file's, with the keys of this
// one laid over it.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene_files.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// No member of a Scene: whoever loads a file puts the base under it. This is its one name, and
/// its text for the pages of keys and the schema.
inline constexpr const char* kBaseKey = "base";
inline constexpr const char* kBaseHelp =
    "Another scene file, from the folder of this one: the scene is that file's, with the keys of "
    "this one laid over it, less its name. Blocks are merged key by key; lists (bodies, obstacles, "
    "gauges) and values are replaced, and off takes a block away. A base may have a base. It lies "
    "in the tree of the first file's folder, or in that of --base-folder.";

/// Files of a chain, the first scene among them.
inline constexpr std::size_t kMostBases = 16;

/// The scene's tree without `base`, laid over those that it names, without their names. `path`: of
/// its file; relative paths of files in a base (bodies[].path) are made relative to the folder of
/// `path`. A base lies in the tree of that folder, or in that of `base_folder` (empty: no other),
/// links followed. What was read is added to `read`. Errors of a base name its place and the files
/// that led there. Throws Error(bad_input).
Node with_bases(Node root, const std::string& path, const std::string& base_folder,
                std::vector<SceneFile>& read);

}  // namespace pbf::inline scene_module
