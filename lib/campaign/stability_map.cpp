#include "lib/campaign/stability_map.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/overrides.h"

namespace pbf::inline campaign_module {
namespace {

[[noreturn]] void bad(const std::string& what) { throw Error(ExitCode::bad_input, what); }

double length(const Double3& v) { return std::hypot(v[0], v[1], v[2]); }

Scene scene_with(const std::string& path, const std::vector<std::string>& overrides,
                 const std::vector<std::string>& more) {
  std::vector<std::string> all = overrides;
  all.insert(all.end(), more.begin(), more.end());
  return load_scene(path, all).scene;
}

/// The scene's field of a number key; of vectors the whole.
Field field_of(Scene& s, const std::string& key) {
  const Key* k = scene_table().find_key(key);
  if (k == nullptr || key.find("[]") != std::string::npos)
    bad("--map: " + key + " is no key of a scene that a map can vary; try time.step,gravity");
  for (const Block* b = k->block; b != nullptr; b = b->parent) b->resize(object(s), 1);
  return k->field(object(s));
}

/// Present value; 0 where the scene leaves it to be chosen.
double value_of(Scene& s, const std::string& key) {
  const Field f = field_of(s, key);
  if (const auto* v = std::get_if<double*>(&f)) return **v;
  if (const auto* v = std::get_if<std::optional<double>*>(&f)) return (*v)->value_or(0);
  if (const auto* v = std::get_if<int*>(&f)) return **v;
  if (const auto* v = std::get_if<Double3*>(&f)) return length(**v);
  bad("--map: " + key + " is not a number");
}

/// KEY=VALUE for the scene reader; of a vector, its length in its own direction, else downwards.
std::string setting(Scene& s, const std::string& key, double value) {
  const Field f = field_of(s, key);
  if (const auto* v = std::get_if<Double3*>(&f)) {
    Double3 direction = **v;
    const double l = length(direction);
    if (l == 0) direction = {0, 0, -1};
    for (double& x : direction) x *= value / (l > 0 ? l : 1);
    return key + "=" + to_text(direction);
  }
  if (std::holds_alternative<int*>(f)) return key + "=" + std::to_string(std::llround(value));
  return key + "=" + to_text(value);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

double number(const std::string& text, const std::string& key) {
  double v = 0;
  if (const NumberError e = read_double(text, v); e != NumberError::none)
    bad("values of " + key + ": \"" + text + "\" " + describe(e));
  return v;
}

}  // namespace

std::vector<double> map_values(const std::string& path, const std::vector<std::string>& overrides,
                               const std::string& key, const std::string& text) {
  std::vector<double> values;
  if (text.empty()) {
    Scene s = scene_with(path, overrides, {});
    const double own = value_of(s, key);
    if (own == 0) bad("--map: " + key + " is 0 in " + path + "; give its values with --x or --y");
    for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) values.push_back(own * factor);
    if (std::holds_alternative<int*>(field_of(s, key))) {
      for (double& v : values) v = std::max(1.0, std::round(v));
      values.erase(std::unique(values.begin(), values.end()), values.end());
    }
    return values;
  }
  const auto range = split(text, ':');
  Scene s = scene_with(path, overrides, {});
  const bool whole = std::holds_alternative<int*>(field_of(s, key));
  if (range.size() == 1) {
    for (const std::string& v : split(text, ',')) {
      values.push_back(number(v, key));
      if (whole && values.back() != std::floor(values.back()))
        bad("values of " + key + ": " + v + " " + describe(NumberError::not_whole));
    }
    return values;
  }
  if (range.size() != 3) bad("values of " + key + ": expected a,b,c or LOW:HIGH:COUNT");
  const double low = number(range[0], key), high = number(range[1], key),
               count = number(range[2], key);
  if (!(low > 0 && high > low && count >= 2 && count <= 1000 && count == std::floor(count)))
    bad("values of " + key + ": " + text + " is no range with 0 < LOW < HIGH and 2 to 1000 values");
  for (int k = 0; k < int(count); ++k) {
    const double v = low * std::pow(high / low, k / (count - 1));
    if (!whole)
      values.push_back(v);
    else if (values.empty() || values.back() != std::round(v))
      values.push_back(std::round(v));
  }
  return values;
}

std::vector<MapCell> map_cells(const StabilityMap& m) {
  std::vector<MapCell> cells;
  for (const int iterations : m.iterations)
    for (const double y : m.y)
      for (const double x : m.x) {
        MapCell c;
        c.x = x;
        c.y = y;
        c.iterations = iterations;
        cells.push_back(c);
      }
  return cells;
}

MapCell run_map_cell(const StabilityMap& m, MapCell c) {
  Scene base = scene_with(m.scene, m.run.overrides, {});
  const std::vector<std::string> settings{"solver.iterations=" + std::to_string(c.iterations),
                                          setting(base, m.x_key, c.x), setting(base, m.y_key, c.y)};
  Scene s = scene_with(m.scene, m.run.overrides, settings);
  const double g0 = length(base.gravity), g = length(s.gravity);
  if (g0 > 0 && g > 0) s.time.end *= std::sqrt(g0 / base.h() / (g / s.h()));
  s.time.end = std::max(s.time.end, s.time.step);
  s.output.reset();
  s.render.reset();
  s.backend = m.run.backend;
  s.precision = m.run.precision;
  s.threads = m.run.threads;
  if (!s.guard) s.guard.emplace();
  // Some hundred measures of every run, however many updates it takes.
  s.measure_every = std::max(1, int(s.time.end / s.time.step / 200));
  c.scene = s.name;
  c.dt_hat = s.time.step * std::sqrt(g / s.h());
  const Course course = run_course(s, std::filesystem::path(m.scene).parent_path().string());
  c.compression_mean = course.compression_mean;
  c.compression_max = course.compression_max;
  c.energy_rise = course.energy_rise;
  if (course.event) {
    c.verdict = MapClass::stopped;
    c.stopped_for = kAlarmNames[static_cast<int>(course.event->alarm)];
  } else if (course.compression_mean > m.limit) {
    c.verdict = MapClass::degraded;
  }
  return c;
}

}  // namespace pbf::inline campaign_module
