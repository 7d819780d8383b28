// Shorter ways to write values, put into the one long way before a scene is read: two numbers for a
// vector in two dimensions, a box by its middle and edges, gravity by its magnitude. What is stored
// and shown of a scene is the long way.
#pragma once

#include "lib/scene/keys.h"
#include "lib/scene/problems.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// Of a scene's tree. What is wrong is added to `problems`, the paths of the keys that it is about
/// are given back, and what stands in the tree for them is good to be read but means nothing: the
/// rest of the scene is looked at too.
std::vector<std::string> write_out(Node& root, Problems& problems);

/// The mapping that `gravity` may be: its table of keys, for the schema.
const KeyTable& gravity_table();

/// Its parts, in the order in which they are called.
bool write_out_gravity(Node& root, Problems& problems);
std::vector<std::string> write_out_boxes(const KeyTable& table, Node& root, Problems& problems);
void write_out_plane(const KeyTable& table, Node& root);

/// Whether the tree says `dimensions: 2`.
bool is_flat(Node& root);
/// A list of numbers that stands where `like` does.
Node list_node(const Node& like, const std::vector<double>& numbers);

}  // namespace pbf::inline scene_module
