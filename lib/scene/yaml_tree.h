// YAML text -> a plain tree that knows where everything stood. yaml-cpp is used behind this only.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

namespace pbf::inline scene_module {

/// Where a tree was read.
struct Origin {
  std::string name;      ///< file name, or the --set argument
  std::string included;  ///< " (included from my.yaml:1)", of what another file names; else empty
  // One word names most origins.
  Origin(const char* file) : name(file) {}
  Origin(std::string file, std::string from = {})
      : name(std::move(file)), included(std::move(from)) {}
  std::string shown() const { return name + included; }
};

/// One value of a YAML document. Depth is limited to kMaxYamlDepth.
struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  std::string text;         ///< scalar; of a null the word that was written, empty: nothing was
  bool quoted = false;      ///< scalar in quotes: text, never a number
  std::vector<Node> keys;   ///< map: keys[i] belongs to items[i], in the order of the file
  std::vector<Node> items;  ///< map and list
  std::shared_ptr<const Origin> origin;
  int line = -1, column = -1;  ///< from 0; -1: the origin alone is the place

  /// "scene.yaml:12:5", or the origin alone.
  std::string place() const;
  /// Child of a map (the first of that name), or nullptr.
  Node* find(const std::string& key);
  /// Takes the first of that name out of a map.
  void erase(const std::string& key);
  /// Whether it is one of these words; in quotes too.
  bool is_word(std::initializer_list<const char*> words) const;
  /// For messages: "4", "a list", "a block", "nothing".
  std::string shown() const;
};

inline constexpr int kMaxYamlDepth = 32;

/// What is wrong with a text as YAML.
struct YamlError {
  std::string place, what;
};

/// Parses one document. Anchors, aliases (and with them documents that multiply when expanded),
/// tags and further documents are refused. `lines`: places carry line and column, else the origin
/// alone. Throws YamlError.
Node parse_yaml(const std::string& text, const Origin& origin, bool lines);

/// f(value, around) for every value at a path of keys ("bodies[].path", each entry's), `around` the
/// map that it is in; also where a part of the path stands in one word ("camera.fov").
void visit(Node& at, const std::string& path, const std::function<void(Node&, Node&)>& f);

}  // namespace pbf::inline scene_module
