// Recognises the kind of an input file from its contents.
#pragma once

#include <string>

#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// Whether a file is named as a scene (*.yaml, *.yml), or as a run file (*.vtkhdf; *.h5 of earlier
/// versions).
bool has_scene_name(const std::string& path);
bool has_run_name(const std::string& path);

/// What is said of a file in the place of a `wanted` ("scene", "study", "stability suite"), by its
/// text before it is read as YAML: "is a list of runs, expected a scene; pbf batch FILE takes it".
/// Empty: it may be one.
std::string other_text(const std::string& text, const std::string& path, const std::string& wanted);
/// The same by its keys.
std::string other_file(Node& root, const std::string& path, const std::string& wanted);

}  // namespace pbf::inline scene_module
