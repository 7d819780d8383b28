// The keys of one scene laid over those of another.
#pragma once

#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// Mappings are merged key by key; every other value, lists too, takes the place of what was there.
/// Where `over` gives another kind to a block that has kinds (tank_motion), the block is replaced
/// as a whole; to a number that was given for gravity, the mapping is added. Keys in one word
/// (solver.iterations) count as what they stand for. What is given twice stays so, to be refused.
/// Both are mappings. Error(bad_input) where a list has no parts to be changed.
void lay_over(Node& base, const Node& over);

}  // namespace pbf::inline scene_module
