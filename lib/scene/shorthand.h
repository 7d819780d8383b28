// Short forms of values, which are expanded before a scene is read: two numbers for a vector in two
// dimensions, a box by center and size, gravity by its magnitude. Stored and printed scenes have
// the full form.
#pragma once

#include "lib/scene/keys.h"
#include "lib/scene/problems.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Expands the short forms in a scene's tree. Errors are added to `problems`; the paths of their
/// keys are returned. The tree then has valid but meaningless values there, so that the rest of the
/// scene can be checked too.
std::vector<std::string> write_out(Node& root, Problems& problems);

/// The table of keys of the mapping that `gravity` may be, for the schema.
const KeyTable& gravity_table();

/// Its parts, in the order of their calls.
bool write_out_gravity(Node& root, Problems& problems);
std::vector<std::string> write_out_boxes(const KeyTable& table, Node& root, Problems& problems);
void write_out_plane(const KeyTable& table, Node& root);

/// Whether the tree says `dimensions: 2`.
bool is_flat(Node& root);
/// A list of numbers with the place of `like`.
Node list_node(const Node& like, const std::vector<double>& numbers);

}  // namespace pbf::scene_module
