// Recognizes the kind of an input file from its contents.
#pragma once

#include <string>

#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Whether the ending is that of a scene (*.yaml, *.yml), or of a run file (*.vtkhdf; *.h5 in
/// earlier versions).
bool has_scene_name(const std::string& path);
bool has_run_name(const std::string& path);

/// A message if a file is not of the `wanted` kind ("scene", "study", "stability suite"), from its
/// text before it is read as YAML: "is a list of runs, expected a scene; pbf batch FILE takes it".
/// Empty if it may be of that kind.
std::string other_text(const std::string& text, const std::string& path, const std::string& wanted);
/// The same from its keys.
std::string other_file(Node& root, const std::string& path, const std::string& wanted);

}  // namespace pbf::scene_module
