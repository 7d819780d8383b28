// Merges the keys of one scene over those of another.
#include <set>

#include "lib/base/error.h"
#include "lib/scene/base_scene.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"

namespace pbf::scene_module {
namespace {

/// Largest number of keys in a block; the search for duplicates is quadratic.
constexpr std::size_t kMostLaid = 10000;

Node* key_node(Node& map, const Node* value) {
  return &map.keys[std::size_t(value - map.items.data())];
}

/// Moves "solver.iterations: 4" of a base into its block, if there is one or `made` asks for one.
void gather_words(Node& base, const std::string& name, bool made) {
  const std::string start = name + ".";
  for (std::size_t i = 0; i < base.keys.size();) {
    if (base.keys[i].kind != Node::Kind::scalar || base.keys[i].text.rfind(start, 0) != 0) {
      ++i;
      continue;
    }
    Node key = base.keys[i], value = base.items[i];
    base.keys.erase(base.keys.begin() + std::ptrdiff_t(i));
    base.items.erase(base.items.begin() + std::ptrdiff_t(i));
    if (!made) continue;  // a value that replaces the block replaces its keys
    Node* block = base.find(name);
    if (block == nullptr) {
      base.append(key.here(Node::Kind::scalar, name), key.here(Node::Kind::map));
      block = &base.items.back();
      i = 0;  // the block is now at the end
    }
    key.text = key.text.substr(start.size());
    if (block->kind == Node::Kind::map) block->append(key, value);
  }
}

/// Makes a number for gravity a mapping that can be tilted; a vector needs a new magnitude.
void take_magnitude(Node& there, const Node& over) {
  double g = 0;
  if (there.kind == Node::Kind::scalar && read_number(there.text, g) == NumberError::none) {
    const Node value = there;
    there = value.here(Node::Kind::map);
    return there.append(value.here(Node::Kind::scalar, "magnitude"), value);
  }
  if (there.kind == Node::Kind::list && over.find("magnitude") == nullptr)
    bad_input(over.place(),
              "gravity: is a vector at " + there.place() +
                  ", of which no part can be changed; give the magnitude here too, or a vector");
}

/// Whether the word that decides which keys the block has changes.
bool is_other_kind(const std::string& path, const Node& there, const Node& over) {
  const Block* block = scene_table().find_block(path);
  if (block == nullptr || block->kind == nullptr) return false;
  const std::string leaf = block->kind->leaf();
  const Node* before = there.find(leaf);
  const Node* now = over.find(leaf);
  return before && now && before->text != now->text;
}

void refuse_many(const Node& node, const std::string& block) {
  if (node.keys.size() > kMostLaid)
    bad_input(node.place(), (block.empty() ? "the scene" : block) + " has more than " +
                                std::to_string(kMostLaid) + " keys; leave some out");
}

void lay(Node& base, const Node& over, const std::string& block);

void lay_value(Node& base, const Node& key, const Node& value, const std::string& block) {
  const std::string path = join(block, key.text);
  const bool map = value.kind == Node::Kind::map;
  if (key.text.find('.') == std::string::npos) gather_words(base, key.text, map);
  Node* there = base.find(key.text);
  if (there == nullptr) {
    const std::size_t dot = key.text.find('.');
    Node* around = dot == std::string::npos ? nullptr : base.find(key.text.substr(0, dot));
    if (around == nullptr || around->kind != Node::Kind::map) return base.append(key, value);
    Node rest = key;
    rest.text = key.text.substr(dot + 1);
    return lay_value(*around, rest, value, join(block, key.text.substr(0, dot)));
  }
  if (map && path == "gravity") take_magnitude(*there, value);
  if (map && there->kind == Node::Kind::list && path != "gravity")
    bad_input(value.place(), path + ": is a block, and the base has a list at " + there->place() +
                                 "; a list is replaced as a whole: give all of it");
  *key_node(base, there) = key;
  if (!map || there->kind != Node::Kind::map || is_other_kind(path, *there, value)) {
    *there = value;
    return;
  }
  refuse_many(*there, path);
  there->origin = value.origin, there->line = value.line, there->column = value.column;
  lay(*there, value, path);
}

void lay(Node& base, const Node& over, const std::string& block) {
  refuse_many(over, block);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < over.keys.size(); ++i) {
    const Node& key = over.keys[i];
    if (key.kind != Node::Kind::scalar || !seen.insert(key.text).second)
      base.append(key, over.items[i]);
    else
      lay_value(base, key, over.items[i], block);
  }
}

}  // namespace

void lay_over(Node& base, const Node& over) {
  refuse_many(base, "");
  base.origin = over.origin, base.line = over.line, base.column = over.column;
  lay(base, over, "");
}

}  // namespace pbf::scene_module
