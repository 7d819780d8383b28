// Scene files: strict YAML in, Scene out; and back to YAML with every default filled in.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/problems.h"
#include "lib/scene/scene.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// What was read, beside the scene: needed to write provenance.
struct LoadedScene {
  Scene scene;
  std::string path;                    ///< of the scene file
  std::string text;                    ///< the file as it stands
  std::string bases;                   ///< files_text() of the files that it builds on
  std::vector<std::string> overrides;  ///< the --set arguments
  std::string folder;                  ///< of the files that it names
  std::string run_file;                ///< that the scene was taken from; empty: none
  std::string files;                   ///< files_text() of what was, or (run file) has been, read
  bool files_known = false;            ///< whether the run file has `files`
  bool auto_step = false;              ///< time.step: auto, chosen without motions so far
  bool named_by_file = false;          ///< the scene says no name
};

/// Reads `path` and the files that it builds on (lib/scene/base_scene.h), which lie in its folder's
/// tree or in that of `base_folder` (empty: no other), applies `--set key.path=value` overrides,
/// validates everything. Throws Error(bad_input) with one line per problem: "file:line:column: key:
/// what, remedy"; Error(bad_input) too when the file is missing, a directory, empty or not text.
LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                       const std::string& base_folder = {});

/// The same from text, which builds on no file; `origin` stands for the file name in messages.
Scene parse_scene(const std::string& text, const std::string& origin,
                  const std::vector<std::string>& overrides);

/// Of a scene that a program has written (run file, checkpoint, run folder), an earlier version
/// too: keys that have been renamed since are read under their old names.
Scene parse_stored_scene(const std::string& text, const std::string& origin,
                         const std::vector<std::string>& overrides);
LoadedScene load_stored_scene(const std::string& path);

/// The tree of a YAML file; `what` it should be, for messages: "study".
Node load_tree(const std::string& path, const std::string& what);

/// The two halves of load_scene, for those who change values in between: the tree of a scene file
/// laid over its bases, and the scene of a tree, with what is wrong added to `problems` (the scene
/// is of no use then). `automatic`: whether time.step was left to be chosen.
Node load_scene_tree(const std::string& path, const std::string& base_folder = {});
Scene scene_of_tree(const Node& root, Problems& problems, bool* automatic = nullptr);

/// YAML of the whole scene, defaults filled in, which parse_scene reads back to an equal scene.
/// Numbers keep all their digits (17).
std::string resolved_yaml(const Scene& scene);

/// The documented reference scene (every key, default, unit, meaning), from the table of keys.
std::string reference_yaml();

/// The same as a page, a table for each block: configs/keys.md.
std::string reference_markdown();

/// JSON Schema (draft 2020-12) of a scene file, from the table of keys.
std::string json_schema();

}  // namespace pbf::inline scene_module
