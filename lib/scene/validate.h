// Converts the tree of a scene file to a Scene, by the table of keys.
#pragma once

#include <map>
#include <set>
#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/problems.h"
#include "lib/scene/scene.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

<<<<<<< HEAD
/// The memory of where each key stood.
struct KeyPlaces {
  std::map<std::string, std::string> places;  ///< of keys and blocks that were given
  std::set<std::string> bad;                  ///< keys with a problem: nothing can be said of them
=======
/// The places of keys in the input.
struct Places {
  std::map<std::string, std::string> places;  ///< of the keys and blocks that were given
  std::set<std::string> bad;                  ///< keys with a problem, which further checks skip
>>>>>>> wt-c3

  /// Place of a key, or of the nearest enclosing block that was given.
  std::string place(const std::string& key) const;
  /// Whether all of these were read without a problem.
  bool good(std::initializer_list<std::string> keys) const;
};

struct PlacedScene : KeyPlaces {
  Scene scene;
};

<<<<<<< HEAD
/// Reads every key of the table into the object, reports what is unknown, misplaced, doubled,
/// missing, of the wrong type or out of range. Paths of lists' keys read "bodies[0].min".
KeyPlaces read_tree(const KeyTable& table, const Node& root, const Object& object,
                    Problems& problems);
/// Gives keys that a program of an earlier version has written the names that they have now.
=======
/// Reads every key of the table into the object; reports unknown, misplaced, duplicate and missing
/// keys, wrong types and values out of range. Paths in lists have the form "bodies[0].min".
Places read_tree(const KeyTable& table, const Node& root, const Object& object, Problems& problems);
/// Replaces the old names of renamed keys, in a tree that an earlier version wrote.
>>>>>>> wt-c3
void use_new_names(const KeyTable& table, Node& node, const std::string& block = "");

/// Checks the rules between keys: valid boxes, bodies inside the domain, times in order, numbers of
/// particles and cells within bounds. Skips keys that already have a problem.
void check_scene(const PlacedScene& placed, Problems& problems);

}  // namespace pbf::inline scene_module
