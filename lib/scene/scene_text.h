// Files of YAML: their text, and the tree that it is.
#pragma once

#include <string>

#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// The text of a file. `what` it should be, for messages and its largest size: "scene". Throws
/// Error(bad_input) where it cannot be read or is a folder. One byte more than may be is read.
std::string text_of_file(const Origin& file, const std::string& what);

/// The tree of a text. Throws Error(bad_input) for what is no text, too large, empty, another kind
/// of file (a study) or no YAML.
Node tree_of_text(const std::string& text, const Origin& origin, const std::string& what);

}  // namespace pbf::inline scene_module
