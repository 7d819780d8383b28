// Conversion of a value between YAML and a field of the scene.
#pragma once

#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// Whether the field is a number or a group of numbers.
bool is_numeric(const Field& field);

/// Whether this number is in the key's range.
bool in_range(const Key& key, double v);

/// Whether "" is a valid text of the key: it is the default, and the key is not required.
bool may_be_empty(const Key& key);

/// Fewest entries of a list in a scene: none if the list that may stand in for it has some.
std::size_t least_entries(const List& list, const Node& scene);

/// Reads `node` into `field`, checking type, choices and range of `key`. Returns an error with a
/// remedy, and leaves the field unchanged, or returns an empty string.
std::string read_field(const Key& key, const Node& node, const Field& field);

/// The field as YAML; read_field reads it back to the same value.
std::string format_field(const Key& key, const Field& field);

/// A YAML scalar that reads back as this text: plain if that is safe, otherwise in quotes.
std::string yaml_text(const std::string& text);

}  // namespace pbf::scene_module
