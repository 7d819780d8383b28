// The name of a scene that says none.
#pragma once

#include <string>

#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// Letters, digits and ".-=_" of a text, with one "-" for others in between: what may stand in the
/// name of a folder on any system. Empty where nothing is left; up to 150 bytes.
std::string plain_name(const std::string& text);

/// Gives a scene without a name that of its file without .yaml, made plain; true if it did. Not of
/// a pipe or another file that is read once, and not where that leaves nothing or a hidden name.
bool name_by_file(Node& root, const std::string& path);

}  // namespace pbf::inline scene_module
