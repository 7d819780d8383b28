#include "lib/run/wave_files.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/run/motion_warnings.h"
#include "lib/scene/number.h"
#include "lib/scene/surface.h"
#include "lib/scene/waves.h"

namespace pbf::run_module {
namespace {

constexpr double kMostTurn = 30;  // degrees
constexpr double kMostRows = 4e6;

/// The row of the table that is farthest towards the waves or, with `turn`, of the largest angle.
std::size_t farthest_row(const MotionTable& table, std::size_t column, double sign, bool turn) {
  const auto far = [&](const std::array<double, 6>& row) {
    return turn ? std::fabs(row[column]) : sign * row[column];
  };
  return std::size_t(std::ranges::max_element(table.values, {}, far) - table.values.begin());
}

/// What is wrong with the stroke of a paddle; empty if nothing is.
std::string stroke_text(const Scene& s, const Obstacle& o) {
  const WaveMaker w = wave_maker(s, o);
  const MotionTable& table = o.motion->table;
  const std::size_t row = farthest_row(table, w.flap ? 4 - w.axis : w.axis, w.sign, w.flap);
  const double most = std::fabs(table.values[row][w.flap ? 4 - w.axis : w.axis]),
               time = table.time[row] - s.time.motion_begin;
  if (w.flap)
    return most > kMostTurn ? fmt::format(
                                  "turns by {:.3g} degrees at {:.4g} s, at most 30 are "
                                  "possible; lower the waves, or put its hinge deeper",
                                  most, time)
                            : "";
  const double length = s.domain.max[w.axis] - s.domain.min[w.axis],
               wall = w.front + w.ahead - length, half = wall + 0.5 * length;
  const auto back_face = std::size_t(2 * w.axis + (w.sign > 0 ? 0 : 1));
  if (s.domain.has_wall(int(w.axis), w.sign < 0) && w.back <= wall && w.back + most > wall)
    return fmt::format(
        "moves by {:.4g} m at {:.4g} s, and the back of its box comes {:.3g} m out of the wall {}; "
        "give the box {:.3g} m more behind the wall",
        most, time, w.back + most - wall, kFaceNames[back_face], w.back + most - wall);
  if (w.front + most > half)
    return fmt::format(
        "moves by {:.4g} m at {:.4g} s, and its front passes the middle of the tank at {:.6g} m; "
        "lower the waves, or make the tank longer",
        most, time, w.sign * half);
  return "";
}

}  // namespace

void make_wave_tables(Scene& s) {
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    Obstacle& o = s.obstacles[k];
    if (!o.motion || !makes_waves(*o.motion)) continue;
    Motion& m = *o.motion;
    const std::string key = (m.origin.text.empty() ? "" : m.origin.text + ": ") + "obstacles[" +
                            std::to_string(k) + "].motion";
    if (m.kind == MotionKind::irregular_waves) m.repeat = repeat_of(s, m);
    m.table = wave_table(s, o, kMostRows);
    if (m.table.time.empty())
      bad_input(key,
                fmt::format("needs {:.3g} rows, 64 in the shortest period of {:.3g} s, at most "
                            "{:g} and one in 1e-6 s are possible; give longer waves, a "
                            "narrower band, or a shorter run",
                            64 * s.time.end / wave_maker(s, o).shortest, wave_maker(s, o).shortest,
                            kMostRows));
    if (const std::string text = stroke_text(s, o); !text.empty()) bad_input(key, text);
  }
}

bool is_wave_file(const std::string& name) {
  return name.starts_with("waves_") && name.ends_with(".csv");
}

std::vector<WaveFile> wave_files(const Scene& s) {
  std::vector<WaveFile> files;
  for (const Obstacle& o : s.obstacles) {
    if (!o.motion || !makes_waves(*o.motion)) continue;
    const WaveMaker w = wave_maker(s, o);
    const MotionTable& table = o.motion->table;
    std::string text = w.flap ? "t,x,y,z,rx,ry,rz" : "t,x,y,z";
    std::vector<double> distances;
    for (const Gauge& g : s.gauges) {
      const auto* level = std::get_if<gauge_keys::Level>(&g.kind);
      if (!level) continue;
      const std::vector<int> across = axes_across_level(s);
      const auto at = std::size_t(std::ranges::find(across, int(w.axis)) - across.begin());
      const double distance = w.sign * level->at[at] - w.front;
      if (distance < 0) continue;
      distances.push_back(distance);
      std::string name = g.name;
      std::ranges::replace_if(
          name, [](char c) { return c == ',' || c == '\n'; }, '_');
      text.append(",eta_").append(name).append("_m");
    }
    for (std::size_t k = 0; k < table.time.size(); ++k) {
      text.append("\n").append(to_text(table.time[k]));
      for (int c = 0; c < table.columns; ++c)
        text.append(",").append(to_text(table.values[k][std::size_t(c)]));
      for (const double distance : distances)
        text += fmt::format(",{:.9f}", w.elevation(distance, table.time[k]));
    }
    files.push_back({wave_file_name(o.name), text + "\n"});
  }
  return files;
}

}  // namespace pbf::run_module
