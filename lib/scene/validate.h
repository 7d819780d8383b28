// Converts the tree of a scene file to a Scene, by the table of keys.
#pragma once

#include <map>
#include <set>
#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/problems.h"
#include "lib/scene/scene.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {

/// The places of keys in the input.
struct KeyPlaces {
  std::map<std::string, std::string> places;  ///< of the keys and blocks that were given
  std::set<std::string> bad;                  ///< keys with a problem, which further checks skip

  /// Place of a key, or of the nearest enclosing block that was given.
  std::string place(const std::string& key) const;
  /// Whether all of these were read without a problem.
  bool good(std::initializer_list<std::string> keys) const;
};

struct PlacedScene : KeyPlaces {
  Scene scene;
};

/// Reads every key of the table into the object; reports unknown, misplaced, duplicate and missing
/// keys, wrong types and values out of range. Paths in lists have the form "bodies[0].min".
KeyPlaces read_tree(const KeyTable& table, const Node& root, const Object& object,
                    Problems& problems);
/// Replaces the old names of renamed keys, in a tree that an earlier version wrote.
void use_new_names(const KeyTable& table, Node& node, const std::string& block = "");

/// Checks the rules between keys: valid boxes, bodies inside the domain, times in order, numbers of
/// particles and cells within bounds. Skips keys that already have a problem.
void check_scene(const PlacedScene& placed, Problems& problems);

}  // namespace pbf::scene_module
