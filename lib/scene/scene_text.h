// YAML files: their text and their tree.
#pragma once

#include <string>

#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// The text of a file. `what`: its kind, for messages and the limit of its size: "scene". Reads at
/// most one byte more than the limit. Throws Error(bad_input) for an unreadable file or a folder.
std::string text_of_file(const Origin& file, const std::string& what);

/// The tree of a text. Throws Error(bad_input) if it is not text, too large, empty, another kind of
/// file (a study) or not YAML.
Node tree_of_text(const std::string& text, const Origin& origin, const std::string& what);

}  // namespace pbf::scene_module
