#include "lib/scene/load.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/plain_text.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/file_kind.h"
#include "lib/scene/keys.h"
#include "lib/scene/overrides.h"
#include "lib/scene/shorthand.h"
#include "lib/scene/validate.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline scene_module {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20;     // of a scene or a study
constexpr std::size_t kMaxResult = std::size_t{256} << 20;  // of what pbf itself wrote

std::size_t limit_of(const std::string& what) {
  return what == "scene" || what == "study" ? kMaxBytes : kMaxResult;
}

void check_text(const std::string& text, const std::string& origin, const std::string& what) {
  if (text.size() > limit_of(what))
    bad_input(origin, "is larger than 4 MiB; many particles belong into a file body (shape: file)");
  if (const auto found = find_bad_text(text))
    bad_input(
        origin + ":" + std::to_string(found->line + 1) + ":" + std::to_string(found->column + 1),
        "is not plain text: " + found->what + "; " + found->remedy + "; expected a " + what +
            " in YAML");
}

std::string read_text_file(const std::string& path, const std::string& what) {
  namespace fs = std::filesystem;
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  if (fs::is_directory(status)) bad_input(path, "is a directory, expected a " + what + " file");
  note_input(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) bad_input(path, "cannot be opened: " + std::string(std::strerror(errno)));
  // One byte more than allowed tells a file that is too large, without reading all of it.
  std::string text(limit_of(what) + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) bad_input(path, "reading failed");
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

Node tree_of(const std::string& text, const std::string& origin, const std::string& what) {
  check_text(text, origin, what);
  if (const std::string other = other_text(text, origin, what); !other.empty())
    bad_input(origin, other);
  try {
    Node root = parse_yaml(text, origin, true);
    if (const std::string other = other_file(root, origin, what); !other.empty())
      bad_input(origin, other);
    if (root.kind != Node::Kind::null) return root;
  } catch (const YamlError& e) {
    bad_input(e.place, e.what);
  }
  bad_input(origin,
            "is empty" + std::string(what == "scene" ? "; `pbf config --example` prints a scene "
                                                       "to start from"
                                                     : ""));
}

Scene scene_with_overrides(Node root, const std::vector<std::string>& overrides) {
  Problems problems;
  for (const std::string& argument : overrides) apply_override(root, argument, problems);
  const Scene scene = scene_of_tree(root, problems);
  problems.raise();
  return scene;
}

template <class Parse>
LoadedScene load(const std::string& path, const std::vector<std::string>& overrides, Parse parse) {
  LoadedScene loaded;
  loaded.path = path;
  loaded.folder = std::filesystem::path(path).parent_path().string();
  loaded.text = read_text_file(path, "scene");
  loaded.overrides = overrides;
  loaded.scene = parse(loaded.text, path, overrides);
  return loaded;
}

/// time.step: auto.
void choose_step(PlacedScene& placed, Problems& problems) {
  double& step = placed.scene.time.step;
  if (placed.bad.empty()) {
    step = auto_step(placed.scene);
    if (step > 0) return;
    problems.add(placed.place("time.step"), "time.step",
                 "auto goes by gravity and the velocities of bodies, and there is neither; give a "
                 "number");
  }
  placed.bad.insert("time.step");
  step = Time{}.step;
}

}  // namespace

Node load_tree(const std::string& path, const std::string& what) {
  return tree_of(read_text_file(path, what), path, what);
}

Scene scene_of_tree(const Node& root, Problems& problems) {
  PlacedScene placed;
  Node tree = root;
  if (!write_out(tree, problems)) return placed.scene;
  static_cast<Places&>(placed) = read_tree(scene_table(), tree, object(placed.scene), problems);
  if (placed.scene.time.step == 0) choose_step(placed, problems);
  check_scene(placed, problems);
  return placed.scene;
}

void use_new_names(const KeyTable& table, Node& node, const std::string& block) {
  if (node.kind == Node::Kind::list)
    for (Node& item : node.items) use_new_names(table, item, block + "[]");
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    const std::string path = (block.empty() ? "" : block + ".") + node.keys[i].text;
    if (const Key* now = table.find_renamed(path)) node.keys[i].text = now->leaf();
    use_new_names(table, node.items[i], path);
  }
}

Scene parse_scene(const std::string& text, const std::string& origin,
                  const std::vector<std::string>& overrides) {
  return scene_with_overrides(tree_of(text, origin, "scene"), overrides);
}

Scene parse_stored_scene(const std::string& text, const std::string& origin,
                         const std::vector<std::string>& overrides) {
  Node root = tree_of(text, origin, "scene");
  use_new_names(scene_table(), root);
  return scene_with_overrides(std::move(root), overrides);
}

LoadedScene load_stored_scene(const std::string& path) {
  return load(path, {}, parse_stored_scene);
}

LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides) {
  return load(path, overrides, parse_scene);
}

}  // namespace pbf::inline scene_module
