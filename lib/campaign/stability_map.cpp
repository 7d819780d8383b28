#include "lib/campaign/stability_map.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/run/linked_files.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/vector3.h"

namespace pbf::campaign_module {
namespace {

constexpr std::size_t kMostCells = 10000000;

Scene scene_with(const std::string& path, const StabilityOptions& run,
                 const std::vector<std::string>& more) {
  std::vector<std::string> all = run.overrides;
  all.insert(all.end(), more.begin(), more.end());
  LoadedScene loaded = load_scene(path, all, run.base_folder);
  read_linked_files(loaded.scene, loaded.folder, loaded.auto_step);
  return loaded.scene;
}

/// The scene's field of a numeric key; a vector is one field.
Field field_of(Scene& s, const std::string& key) {
  const Key* k = scene_table().find_key(key);
  if (k == nullptr || key.find("[]") != std::string::npos)
    bad_input("--map", key + " is no key of a scene that a map can vary; try time.step,gravity");
  for (const Block* b = k->block; b != nullptr; b = b->parent) b->resize(object(s), 1);
  return k->field(object(s));
}

/// Present value; 0 if the scene leaves it to the program.
double value_of(Scene& s, const std::string& key) {
  const Field f = field_of(s, key);
  if (const auto* v = std::get_if<double*>(&f)) return **v;
  if (const auto* v = std::get_if<std::optional<double>*>(&f)) return (*v)->value_or(0);
  if (const auto* v = std::get_if<int*>(&f)) return **v;
  if (const auto* v = std::get_if<Double3*>(&f)) return length(**v);
  bad_input("--map", key + " is not a number");
}

/// The values in the form of a scene file; for a vector, `value` is its length, and its direction
/// is kept (downwards if it is 0).
GridAxis axis_of(Scene& s, const std::string& key, const std::vector<double>& values) {
  const Field f = field_of(s, key);
  std::vector<std::string> texts;
  for (const double value : values) {
    texts.push_back(to_text(value));
    if (std::holds_alternative<int*>(f)) texts.back() = std::to_string(std::llround(value));
    if (const auto* v = std::get_if<Double3*>(&f)) {
      const double l = length(**v);
      texts.back() = to_text(l > 0 ? (value / l) * **v : Double3{0, 0, -value});
    }
  }
  return grid_axis(key, texts);
}

}  // namespace

std::vector<double> map_values(const std::string& path, const StabilityOptions& run,
                               const std::string& key, const std::string& text) {
  Scene s = scene_with(path, run, {});
  const bool whole = std::holds_alternative<int*>(field_of(s, key));
  if (!text.empty()) return numbers_listed(key, text, whole);
  const double own = value_of(s, key);
  if (own == 0) bad_input("--map", key + " is 0 in " + path + "; give its values with --x or --y");
  std::vector<double> values;
  for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0})
    values.push_back(whole ? std::max(1.0, std::round(own * factor)) : own * factor);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<MapCell> map_cells(const StabilityMap& m) {
  Scene base = scene_with(m.scene, m.run, {});
  std::vector<MapCell> cells;
  for (const GridMember& member :
       grid_members({grid_axis("solver.iterations", m.iterations), axis_of(base, m.y_key, m.y),
                     axis_of(base, m.x_key, m.x)},
                    kMostCells, "--map")) {
    MapCell& c = cells.emplace_back();
    c.settings = override_texts(member.settings);
    c.iterations = m.iterations[member.at[0]];
    c.y = m.y[member.at[1]];
    c.x = m.x[member.at[2]];
  }
  return cells;
}

std::optional<MapCell> run_map_cell(const StabilityMap& m, MapCell c) {
  const Scene base = scene_with(m.scene, m.run, {});
  Scene s = scene_with(m.scene, m.run, c.settings);
  const double g0 = length(base.gravity), g = length(s.gravity);
  if (g0 > 0 && g > 0) s.time.end *= std::sqrt(g0 / base.h() / (g / s.h()));
  s.time.end = std::max(s.time.end, s.time.step);
  without_files(s, m.run);
  if (!s.guard) s.guard.emplace();
  // About 200 measurements per run, however many updates it makes.
  s.measure_every = std::max(1, int(s.time.end / s.time.step / 200));
  c.scene = s.name;
  c.dt_hat = relative_step(s);
  const std::string dir = std::filesystem::path(m.scene).parent_path().string();
  const auto ran = run_course(prepare(s, dir, {.fits = false}), m.run.stop);
  if (!ran) return std::nullopt;
  const Course& course = *ran;
  static_cast<Figures&>(c) = course;
  if (course.event) {
    c.verdict = MapClass::stopped;
    c.stopped_for = kAlarmNames[static_cast<int>(course.event->alarm)];
  } else if (course.compression_mean > m.limit) {
    c.verdict = MapClass::degraded;
  }
  return c;
}

}  // namespace pbf::campaign_module
