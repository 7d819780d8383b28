// Merges the keys of one scene over those of another.
#pragma once

#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Mappings are merged key by key; every other value, also a list, replaces the previous one. If
/// `over` changes the kind of a block that has kinds (tank_motion), the block is replaced as a
/// whole; a mapping for gravity extends a number. A path in one word (solver.iterations) counts as
/// the key in its block. Duplicate keys stay, to be refused later. Both nodes are mappings. Throws
/// Error(bad_input) for a block over a list.
void lay_over(Node& base, const Node& over);

}  // namespace pbf::scene_module
