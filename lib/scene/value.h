// One value between YAML and a field of the scene.
#pragma once

#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// Whether the field is a number or a group of numbers.
bool is_numeric(const Field& field);

/// Whether the key may have this number.
bool in_range(const Key& key, double v);

/// Whether "" is a value of the key, which holds text: "" is its default, and none is required.
bool may_be_empty(const Key& key);

/// Reads `node` into `field`, checking type, choices and range of `key`. Returns what is wrong,
/// with the remedy, or an empty string. The field is unchanged when something is wrong.
std::string read_field(const Key& key, const Node& node, const Field& field);

/// The field as YAML; read_field reads it back to the same value.
std::string format_field(const Key& key, const Field& field);

/// Text as a YAML scalar that reads back as this text: bare where that is safe, else in quotes.
std::string yaml_text(const std::string& text);

}  // namespace pbf::inline scene_module
