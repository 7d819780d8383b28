// The name of a scene that has none.
#pragma once

#include <string>

#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Keeps letters, digits and ".-=_", and replaces other characters by single "-", for names of
/// folders on any system. At most 150 bytes; may be empty.
std::string plain_name(const std::string& text);

/// Names a scene without a name after its file (plain_name() without .yaml); returns whether it
/// did. Not for a pipe or another special file, and not if the name would be empty or hidden.
bool name_by_file(Node& root, const std::string& path);

}  // namespace pbf::scene_module
