#include "lib/scene/base_scene.h"

#include <fmt/core.h>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"
#include "lib/scene/keys.h"
#include "lib/scene/scene_text.h"

namespace pbf::scene_module {
namespace {

namespace fs = std::filesystem;

/// Resolves links. A missing file keeps its name, and a pipe the name that it was given by.
fs::path real(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path.empty() ? "." : path);
  const fs::path found = fs::weakly_canonical(whole, error);
  return error ? whole.lexically_normal() : found;
}

bool is_within(const fs::path& file, const fs::path& folder) {
  const fs::path way = file.lexically_relative(folder);
  return !way.empty() && *way.begin() != "..";
}

class Chain {
 public:
  Chain(const std::string& path, const std::string& base_folder, std::vector<SceneFile>& read)
      : read_(read) {
    files_.push_back({path, real(path), ""});
    trees_.push_back(real(fs::path(path).parent_path()));
    if (!base_folder.empty()) trees_.push_back(real(base_folder));
  }

  /// `over`: the tree of the last file.
  Node build(Node over) {
    if (over.kind != Node::Kind::map) return over;
    const Node* named = over.find(kBaseKey);
    if (named == nullptr) return over;
    const Node at = *named;
    take_out(over, kBaseKey);
    const std::string word = word_of(at);
    const fs::path beside = fs::path(files_.back().path).parent_path();
    Node tree = build(tree_of(at, (beside / word).string()));
    take_out(tree, "name");  // of the base's runs: scenes on one base must not share a folder
    make_relative(tree, fs::path(word).parent_path());
    lay_over(tree, over);
    return tree;
  }

 private:
  struct File {
    std::string path;
    fs::path real;
    std::string included;  ///< as in Origin
  };

  [[noreturn]] static void bad(const Node& at, const std::string& what) {
    bad_input(at.place(), "base: " + what);
  }

  /// Removes a key of the top level, if it is there.
  static void take_out(Node& tree, const std::string& key) {
    const Node* there = tree.find(key);
    if (there == nullptr) return;
    const std::string first = there->place();
    tree.erase(key);
    if (const Node* again = tree.find(key))
      bad_input(again->place(), key + ": given twice, first at " + first + "; remove one");
  }

  static std::string word_of(const Node& at) {
    if (at.kind == Node::Kind::list || at.kind == Node::Kind::map)
      bad(at, "expected the path of one scene file, got " + at.shown() +
                  "; a base may have a base of its own");
    if (at.kind == Node::Kind::null || at.text.empty())
      bad(at, "names no file; give the path of a scene file, or remove the key");
    if (!at.quoted && at.is_word({"off", "false", "on", "true"}))
      bad(at, "is " + at.shown() +
                  ", expected the path of a scene file; without one remove the "
                  "key");
    return at.text;
  }

  /// Reads the file that `at` names.
  Node tree_of(const Node& at, const std::string& path) {
    const File file{path, real(path), included(at)};
    check(at, file);
    files_.push_back(file);
    const Origin origin(file.path, file.included);
    const std::string text = text_of_file(origin, "scene");
    Node tree = tree_of_text(text, origin, "scene");
    if (tree.kind != Node::Kind::map)
      bad_input(tree.place(), "is " + tree.shown() + ", expected a scene: keys and their values");
    read_.push_back({file.path, sha256(text)});
    return tree;
  }

  /// " (included from mid.yaml:1, from my.yaml:1)"
  std::string included(const Node& at) const {
    const std::string& before = files_.back().included;
    const std::string rest =
        before.empty() ? ")" : ", " + before.substr(std::string(" (included ").size());
    return fmt::format(" (included from {}:{}{}", files_.back().path, at.line + 1, rest);
  }

  void check(const Node& at, const File& file) const {
    const std::string shown = one_line(file.path);
    for (const File& other : files_)
      if (other.real == file.real) bad(at, "comes back to where it began: " + chain_to(file));
    if (files_.size() >= kMostBases)
      bad(at, fmt::format("the chain is longer than {} files: {}", kMostBases, chain_to(file)));
    bool within = false;
    for (const fs::path& tree : trees_) within = within || is_within(file.real, tree);
    if (!within)
      bad(at, shown + " (" + file.real.string() + ") lies outside " + trees_[0].string() +
                  ", the folder of " + files_[0].path +
                  "; move it there, or name a folder around "
                  "it with --base-folder");
    std::error_code error;
    const fs::file_status status = fs::status(file.path, error);
    if (status.type() == fs::file_type::not_found)
      bad(at, shown + " is not there (looked for " + file.real.string() +
                  "); its path counts from the folder of " + files_.back().path);
    if (const std::string kind = not_regular(file.path); !kind.empty())
      bad(at, shown + " is " + kind + ", expected a scene file");
  }

  std::string chain_to(const File& file) const {
    std::string text;
    for (const File& f : files_) text += f.path + " -> ";
    return one_line(text + file.path, 1000);
  }

  /// Paths of files in a base are relative to its own folder; makes them relative to the scene's.
  static void make_relative(Node& tree, const fs::path& way) {
    if (way.empty()) return;
    for (const Key& key : scene_table().keys)
      if (key.names_file)
        visit(tree, key.path, [&](Node& value, Node&) {
          if (value.kind == Node::Kind::scalar && !value.text.empty())
            value.text = (way / value.text).string();  // an absolute path stays
        });
  }

  std::vector<File> files_;
  std::vector<fs::path> trees_;
  std::vector<SceneFile>& read_;
};

}  // namespace

Node with_bases(Node root, const std::string& path, const std::string& base_folder,
                std::vector<SceneFile>& read) {
  if (root.kind != Node::Kind::map || root.find(kBaseKey) == nullptr) return root;
  return Chain(path, base_folder, read).build(std::move(root));
}

}  // namespace pbf::scene_module
