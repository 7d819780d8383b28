#include "lib/run/linked_files.h"

#include <filesystem>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "lib/run/motion_files.h"
#include "lib/run/surface_files.h"
#include "lib/run/wave_files.h"
#include "lib/scene/validate.h"

namespace pbf::run_module {
namespace {

namespace fs = std::filesystem;

/// Calls f(what names the file, key) for each of them. Scene may be const.
template <class AnyScene, class F>
void for_each_file(AnyScene& s, F&& f) {
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const std::string name = "obstacles[" + std::to_string(k) + "]";
    std::visit(
        [&](auto& shape) {
          if constexpr (requires { shape.surface; }) f(shape, name + ".path");
        },
        s.obstacles[k].shape);
    if (auto& m = s.obstacles[k].motion; m && m->kind == MotionKind::file)
      f(*m, name + ".motion.path");
  }
  if (auto& m = s.tank_motion; m && m->kind == TankMotionKind::file)
    f(*m, std::string("tank_motion.path"));
  for (std::size_t k = 0; k < s.emitters.size(); ++k)
    if (auto& e = s.emitters[k]; !e.path.empty()) f(e, "emitters[" + std::to_string(k) + "].path");
}

/// Where a file was read, and the hash of its bytes; empty before.
std::pair<std::string, std::string> read_from(const auto& f) {
  if constexpr (requires { f.surface; })
    return f.surface ? std::pair{f.surface->file(), f.surface->sha256()}
                     : std::pair<std::string, std::string>();
  else
    return {f.table.file, f.table.sha256};
}

const Place& place_of(const auto& f) {
  if constexpr (requires { f.origin; })
    return f.origin;
  else
    return f.place;
}

}  // namespace

void read_linked_files(Scene& scene, const std::string& dir, bool auto_step) {
  std::map<std::string, std::shared_ptr<const SolidMesh>> meshes;  // of several obstacles
  bool more_rules = false;  // that depend on the extents of obstacles and the speeds of emitters
  for (Obstacle& o : scene.obstacles)
    if (auto* f = o.surface_file()) f->surface.reset();
  for_each_file(scene, [&](auto& m, const std::string& name) {
    const std::string key = (place_of(m).text.empty() ? "" : place_of(m).text + ": ") + name,
                      file = (fs::path(dir) / m.path).string();
    using Linked = std::decay_t<decltype(m)>;
    if constexpr (std::is_same_v<Linked, obstacle_keys::Heights>) {
      m.surface = read_heights(scene, m.translate, key, file);
    } else if constexpr (std::is_same_v<Linked, obstacle_keys::Mesh>) {
      std::shared_ptr<const SolidMesh>& mesh = meshes[file];
      if (!mesh) mesh = read_surface(key, file);
      m.surface = mesh;
    } else {
      read_motion(scene, m, key, file);
    }
    if constexpr (requires { m.surface; } || std::is_same_v<Linked, Emitter>) more_rules = true;
  });
  make_wave_tables(scene);
  if (more_rules) {
    PlacedScene placed;
    placed.scene = scene;
    Problems problems;
    check_scene(placed, problems);
    problems.raise();
  }
  if (auto_step) choose_step_of_motions(scene);
}

std::vector<std::string> linked_paths(const Scene& scene) {
  std::vector<std::string> all;
  for_each_file(scene, [&](const auto& f, const std::string&) { all.push_back(f.path); });
  return all;
}

std::vector<SceneFile> linked_files(const Scene& scene) {
  std::vector<SceneFile> files;
  for_each_file(scene, [&](const auto& f, const std::string&) {
    files.push_back({f.path, read_from(f).second});
  });
  return files;
}

void make_paths_absolute(Scene& scene) {
  for_each_file(scene, [](auto& f, const std::string&) { f.path = read_from(f).first; });
}

}  // namespace pbf::run_module
