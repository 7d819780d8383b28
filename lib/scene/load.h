// Scene files: strict YAML in, Scene out; and back to YAML with every default filled in.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/problems.h"
#include "lib/scene/scene.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// A scene and what was read for it, as needed for provenance.
struct LoadedScene {
  Scene scene;
  std::string path;                    ///< of the scene file
  std::string text;                    ///< the unchanged text of the file
  std::string bases;                   ///< files_text() of its base scenes
  std::vector<std::string> overrides;  ///< the --set arguments
  std::string folder;                  ///< that anchors the paths in the scene
  std::string run_file;                ///< that holds the scene; empty: none
  std::string files;                   ///< files_text() of the files read, or of the run file
  bool files_known = false;            ///< whether the run file has `files`
  bool auto_step = false;              ///< time.step was auto, and chosen without motions so far
  bool named_by_file = false;          ///< the scene has no name of its own
};

/// Reads `path` and its base scenes (lib/scene/base_scene.h), which lie below its folder or below
/// `base_folder` (empty: none), applies `--set key.path=value` overrides and validates everything.
/// Throws Error(bad_input) with one line per problem, "file:line:column: key: what, remedy"; also
/// if the file is missing, a directory, empty or not text.
LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                       const std::string& base_folder = {});

/// The same from text without bases; `origin` replaces the file name in messages.
Scene parse_scene(const std::string& text, const std::string& origin,
                  const std::vector<std::string>& overrides);

/// For a scene that the program stored (run file, checkpoint, run folder), also in an earlier
/// version: renamed keys are read under their old names.
Scene parse_stored_scene(const std::string& text, const std::string& origin,
                         const std::vector<std::string>& overrides);
LoadedScene load_stored_scene(const std::string& path);

/// The tree of a YAML file; `what`: its kind, for messages: "study".
Node load_tree(const std::string& path, const std::string& what);

/// The two halves of load_scene, for callers that change values in between: the tree of a scene
/// file merged with its bases, and the scene of a tree; errors are added to `problems` (then the
/// scene is not usable). `automatic`: whether time.step was auto.
Node load_scene_tree(const std::string& path, const std::string& base_folder = {});
Scene scene_of_tree(const Node& root, Problems& problems, bool* automatic = nullptr);

/// YAML of the whole scene with every default, which parse_scene() reads back to an equal scene.
/// Numbers have up to 17 digits.
std::string resolved_yaml(const Scene& scene);

/// The documented reference scene (every key, default, unit, meaning), from the table of keys.
std::string reference_yaml();

/// The same as a page with a table per block: configs/keys.md.
std::string reference_markdown();

/// JSON Schema (draft 2020-12) of a scene file, from the table of keys.
std::string json_schema();

}  // namespace pbf::scene_module
