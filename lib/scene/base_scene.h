// `base: other.yaml` at the top of a scene file: the keys of this file override those of the other.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene_files.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Not a member of Scene: loading merges the base into the tree. The only definition of the key's
/// name, and of its text for the pages of keys and the schema.
inline constexpr const char* kBaseKey = "base";
inline constexpr const char* kBaseHelp =
    "Another scene file, from the folder of this one: the scene is that file's, with the keys of "
    "this one laid over it, less its name. Blocks are merged key by key; lists (bodies, obstacles, "
    "gauges) and values are replaced, and off takes a block away. A base may have a base. It lies "
    "in the tree of the first file's folder, or in that of --base-folder.";

/// Largest number of files in a chain, with the first scene.
inline constexpr std::size_t kMostBases = 16;

/// The scene's tree without `base`, merged over the trees of its bases, whose names are dropped.
/// `path`: of its file; relative paths of files in a base (bodies[].path) are made relative to the
/// folder of `path`. A base must lie below that folder or below `base_folder` (empty: none), after
/// links are resolved. Files that were read are added to `read`. Error messages name the place in a
/// base and the files that led there. Throws Error(bad_input).
Node with_bases(Node root, const std::string& path, const std::string& base_folder,
                std::vector<SceneFile>& read);

/// Merges the keys of one scene over those of another (lay_over.cpp). Mappings are merged key by
/// key; every other value, also a list, replaces the previous one. If `over` changes the kind of a
/// block that has kinds (tank_motion), the block is replaced as a whole; a mapping for gravity
/// extends a number. A path in one word (solver.iterations) counts as the key in its block.
/// Duplicate keys stay, to be refused later. Both nodes are mappings. Throws Error(bad_input) for a
/// block over a list.
void lay_over(Node& base, const Node& over);

}  // namespace pbf::scene_module
