#include "lib/scene/load.h"

#include <algorithm>
#include <filesystem>

#include "lib/scene/auto_step.h"
#include "lib/scene/base_scene.h"
#include "lib/scene/keys.h"
#include "lib/scene/overrides.h"
#include "lib/scene/scene_name.h"
#include "lib/scene/scene_text.h"
#include "lib/scene/shorthand.h"
#include "lib/scene/validate.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::scene_module {
namespace {

Scene scene_with_overrides(Node root, const std::vector<std::string>& overrides,
                           bool* automatic = nullptr) {
  Problems problems;
  for (const std::string& argument : overrides) apply_override(root, argument, problems);
  const Scene scene = scene_of_tree(root, problems, automatic);
  problems.raise();
  return scene;
}

LoadedScene loaded_from(const std::string& path) {
  LoadedScene loaded;
  loaded.path = path;
  loaded.folder = std::filesystem::path(path).parent_path().string();
  loaded.text = text_of_file(path, "scene");
  return loaded;
}

/// A base is read with its file; an override cannot set it.
void refuse_base(Node& root, Problems& problems) {
  const Node* base = root.find(kBaseKey);
  if (base == nullptr) return;
  problems.add(base->place(), kBaseKey,
               "is read with the scene file that it stands in, and is nothing to set; write it at "
               "the top of that file");
  root.erase(kBaseKey);
}

/// Chooses time.step if it is auto.
void choose_step(PlacedScene& placed, Problems& problems) {
  double& step = placed.scene.time.step;
  if (placed.bad.empty()) {
    step = auto_step(placed.scene);
    if (step > 0) return;
    const Scene& s = placed.scene;
    if (s.tank_motion || std::ranges::any_of(s.obstacles, [](auto& o) { return o.moves(); })) {
      step = s.output ? s.output->every : s.time.end;  // until the tables are read
      return;
    }
    problems.add(placed.place("time.step"), "time.step",
                 "auto goes by gravity, the velocities of bodies and motions, and there are none; "
                 "give a number");
  }
  placed.bad.insert("time.step");
  step = Time{}.step;
}

/// A kinematic viscosity alone is all the viscosity there is.
void choose_viscosity(PlacedScene& placed) {
  std::optional<Viscosity>& v = placed.scene.viscosity;
  if (v && v->kinematic && !placed.places.contains("viscosity.xsph")) v->xsph = 0;
}

/// Keeps the places of paths whose files are read later.
void keep_places(PlacedScene& placed) {
  Scene& s = placed.scene;
  for (std::size_t k = 0; k < s.bodies.size(); ++k)
    s.bodies[k].place.text = placed.place("bodies[" + std::to_string(k) + "].path");
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const std::string name = "obstacles[" + std::to_string(k) + "]";
    if (auto& motion = s.obstacles[k].motion)
      motion->origin.text = placed.place(name + ".motion.path");
    if (auto* file = s.obstacles[k].surface_file()) file->place.text = placed.place(name + ".path");
  }
  if (s.tank_motion) s.tank_motion->place.text = placed.place("tank_motion.path");
  for (std::size_t k = 0; k < s.emitters.size(); ++k)
    s.emitters[k].place.text = placed.place("emitters[" + std::to_string(k) + "].path");
  for (std::size_t k = 0; k < s.compare.size(); ++k)
    s.compare[k].place.text = placed.place("compare[" + std::to_string(k) + "].data");
}

}  // namespace

Node load_tree(const std::string& path, const std::string& what) {
  return tree_of_text(text_of_file(path, what), path, what);
}

Node load_scene_tree(const std::string& path, const std::string& base_folder) {
  std::vector<SceneFile> bases;
  Node root = with_bases(load_tree(path, "scene"), path, base_folder, bases);
  name_by_file(root, path);
  return root;
}

Scene scene_of_tree(const Node& root, Problems& problems, bool* automatic) {
  PlacedScene placed;
  Node tree = root;
  refuse_base(tree, problems);
  const std::vector<std::string> bad = write_out(tree, problems);
  static_cast<KeyPlaces&>(placed) = read_tree(scene_table(), tree, object(placed.scene), problems);
  placed.bad.insert(bad.begin(), bad.end());
  if (automatic != nullptr) *automatic = placed.scene.time.step == 0;
  if (placed.scene.time.step == 0) choose_step(placed, problems);
  choose_viscosity(placed);
  check_scene(placed, problems);
  keep_places(placed);
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
  return scene_with_overrides(tree_of_text(text, origin, "scene"), overrides);
}

Scene parse_stored_scene(const std::string& text, const std::string& origin,
                         const std::vector<std::string>& overrides) {
  Node root = tree_of_text(text, origin, "scene");
  use_new_names(scene_table(), root);
  return scene_with_overrides(std::move(root), overrides);
}

LoadedScene load_stored_scene(const std::string& path) {
  LoadedScene loaded = loaded_from(path);
  loaded.scene = parse_stored_scene(loaded.text, path, {});
  return loaded;
}

LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                       const std::string& base_folder) {
  LoadedScene loaded = loaded_from(path);
  loaded.overrides = overrides;
  std::vector<SceneFile> bases;
  Node root = with_bases(tree_of_text(loaded.text, path, "scene"), path, base_folder, bases);
  loaded.bases = files_text(bases);
  loaded.named_by_file = name_by_file(root, path);
  loaded.scene = scene_with_overrides(std::move(root), overrides, &loaded.auto_step);
  return loaded;
}

}  // namespace pbf::scene_module
