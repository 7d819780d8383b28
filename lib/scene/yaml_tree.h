// Parses YAML text into a plain tree with the place of every value. Only this uses yaml-cpp.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pbf::scene_module {

/// The source of a tree.
struct Origin {
  std::string name;      ///< file name, or the --set argument
  std::string included;  ///< " (included from my.yaml:1)" for a base; else empty
  // Most origins are only a name.
  Origin(const char* file) : name(file) {}
  Origin(std::string file, std::string from = {})
      : name(std::move(file)), included(std::move(from)) {}
  std::string shown() const { return name + included; }
};

/// One value of a YAML document. Depth is limited to kMaxYamlDepth.
struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  std::string text;         ///< of a scalar; of a null the written word, if any
  bool quoted = false;      ///< scalar in quotes: text, never a number
  std::vector<Node> keys;   ///< map: keys[i] belongs to items[i], in the order of the file
  std::vector<Node> items;  ///< map and list
  std::shared_ptr<const Origin> origin;
  int line = -1, column = -1;  ///< from 0; -1: unknown

  /// "scene.yaml:12:5", or the origin alone.
  std::string place() const;
  /// A node with the place of this one.
  Node here(Kind of, std::string word = {}) const {
    return {of, std::move(word), false, {}, {}, origin, line, column};
  }
  /// The first child of a map with this key, or nullptr.
  Node* find(const std::string& key);
  const Node* find(const std::string& key) const { return const_cast<Node*>(this)->find(key); }
  /// Adds a pair to a map.
  void append(Node key, Node value) {
    keys.push_back(std::move(key)), items.push_back(std::move(value));
  }
  /// Removes the first child with this key from a map.
  void erase(const std::string& key);
  /// Whether it is one of these words, quoted or not.
  bool is_word(std::initializer_list<const char*> words) const;
  /// For messages: "4", "a list", "a block", "nothing".
  std::string shown() const;
};

inline constexpr int kMaxYamlDepth = 32;

/// An error of the YAML syntax.
struct YamlError {
  std::string place, what;
};

/// Parses one document. Refuses anchors and aliases (which could make a document explode when
/// expanded), tags and further documents. `lines`: places have line and column, otherwise only the
/// origin. Throws YamlError.
Node parse_yaml(const std::string& text, const Origin& origin, bool lines);

/// Calls f(value, parent map) for every value at a path of keys (for "bodies[].path", of each
/// entry), also if part of the path is written in one word ("camera.fov").
void visit(Node& at, const std::string& path, const std::function<void(Node&, Node&)>& f);

}  // namespace pbf::scene_module
