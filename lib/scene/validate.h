// Tree of a scene file -> Scene, by the table of keys.
#pragma once

#include <map>
#include <set>
#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/problems.h"
#include "lib/scene/scene.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {

/// The memory of where each key stood.
struct KeyPlaces {
  std::map<std::string, std::string> places;  ///< of keys and blocks that were given
  std::set<std::string> bad;                  ///< keys with a problem: nothing can be said of them

  /// Place of a key, or of the nearest block around it that was given.
  std::string place(const std::string& key) const;
  /// Whether all of these were read without a problem.
  bool good(std::initializer_list<std::string> keys) const;
};

struct PlacedScene : KeyPlaces {
  Scene scene;
};

/// Reads every key of the table into the object, reports what is unknown, misplaced, doubled,
/// missing, of the wrong type or out of range. Paths of lists' keys read "bodies[0].min".
KeyPlaces read_tree(const KeyTable& table, const Node& root, const Object& object,
                    Problems& problems);
/// Gives keys that a program of an earlier version has written the names that they have now.
void use_new_names(const KeyTable& table, Node& node, const std::string& block = "");

/// What holds between keys: boxes not inverted, bodies inside the domain, times in order, numbers
/// of particles and cells within bounds. Skips what has a problem already.
void check_scene(const PlacedScene& placed, Problems& problems);

}  // namespace pbf::inline scene_module
