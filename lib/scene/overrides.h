// Puts `--set key.path=value` into the tree of a scene file before the tree is checked.
#pragma once

#include <string>

#include "lib/scene/problems.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Replaces or creates the value at the key's path: "solver.iterations=8", "bodies.0.count=10",
/// "bodies[0].count=10", "viscosity=off". The value is YAML. Missing blocks are created. A path
/// that does not fit the tree goes to `problems`; unknown keys are left to validation.
void apply_override(Node& root, const std::string& argument, Problems& problems);

/// The same with a value that was parsed before; messages name its place.
void set_value(Node& root, const std::string& path, const Node& value, Problems& problems);

}  // namespace pbf::scene_module
