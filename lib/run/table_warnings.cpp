// Warnings about tables of motion.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/program/motion.h"
#include "lib/program/motion_table.h"
#include "lib/run/motion_warnings.h"
#include "lib/scene/difference.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {
namespace {

struct Swinging {
  double beyond = 0;  ///< overshoot, in the column's unit
  double metres = 0;  ///< the same as a length, for comparison
  double time = 0;    ///< s, of the table
  double row = 0;     ///< the value of the overshot row
  std::size_t piece = 0, column = 0;
};

/// Whether the sampled motion itself may turn back between these rows: the slopes have opposite
/// signs, and the one farther from the turn is not much smaller (near a stop it is).
bool is_crest(const CurvePiece& p, bool up) {
  if (!(p.slope0 * p.slope1 < 0)) return false;
  const bool first = up ? p.y0 >= p.y1 : p.y0 <= p.y1;
  const double near = std::fabs(first ? p.slope0 : p.slope1);
  const double far = std::fabs(first ? p.slope1 : p.slope0);
  return far >= 0.5 * near;
}

/// The largest overshoot of the curves beyond their rows. `lengths`: m per unit of each column.
Swinging farthest_swing(const MotionTable& table, double from, double to,
                        const std::vector<double>& lengths) {
  Swinging worst;
  const std::size_t last = piece_at(table, to);
  for (std::size_t k = piece_at(table, from); k <= last; ++k)
    for (std::size_t c = 0; c < lengths.size(); ++c) {
      const CurvePiece p = curve_piece(table, c, k);
      std::vector<double> times = p.turns();
      // The run may end before the turn.
      if (!times.empty() && k == last && to > p.begin) times.push_back(to);
      for (const double t : times) {
        if (t < from || t > to) continue;
        const double y = cubic(table, c, t), high = std::max(p.y0, p.y1),
                     low = std::min(p.y0, p.y1);
        const bool up = y > high;
        const double beyond = up ? y - high : low - y;
        if (!(beyond * lengths[c] > worst.metres) || is_crest(p, up)) continue;
        worst = {beyond, beyond * lengths[c], t, up ? high : low, k, c};
      }
    }
  return worst;
}

/// "fall.csv:4 and 5"
std::string rows_text(const MotionTable& t, std::size_t piece) {
  const std::string file = std::filesystem::path(t.file).filename().string();
  if (t.line.size() != t.time.size()) return file;
  return fmt::format("{}, lines {} and {}", file, t.line[piece], t.line[piece + 1]);
}

/// Detects a table of positions instead of displacements: its first row is far from 0.
std::string displaced_text(const Scene& s, std::size_t k) {
  const MotionTable& table = s.obstacles[k].motion->table;
  if (table.values.empty() || s.time.motion_begin != 0) return "";
  const std::array<double, 6>& v = table.values[0];
  const double away = std::hypot(v[0], v[1], v[2]);
  if (!(away > s.fluid.spacing)) return "";
  return named(s, k) + fmt::format(
                           " is {:.3g} m away from its place in the scene at the first row of its "
                           "table ({}): x, y, z there count from that place; begin with 0,0,0",
                           away, std::filesystem::path(table.file).filename().string());
}

std::string table_text(const std::string& who, const MotionTable& table,
                       const std::vector<const char*>& names, const std::vector<double>& lengths,
                       const Scene& s) {
  if (table.time.size() < 2) return "";
  const double begin = s.time.motion_begin;
  const Swinging w = farthest_swing(table, begin, begin + s.time.end, lengths);
  if (!(w.metres > 0.1 * s.fluid.spacing)) return "";
  const bool angle = names[w.column][0] == 'r' || names[w.column][0] == 'a';
  const char* unit = angle ? "degrees" : "m";
  return fmt::format(
      "{}: its smooth curve swings beyond the rows of the table: {} goes to {:.4g} at {:.4g} s, "
      "{:.2g} {} beyond the {:.4g} of the rows at {:.4g} and {:.4g} s ({})",
      who, names[w.column], cubic(table, w.column, w.time), w.time, w.beyond, unit, w.row,
      table.time[w.piece], table.time[w.piece + 1], rows_text(table, w.piece));
}

}  // namespace

std::string tables_text(const Scene& s) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  std::vector<std::string> texts, displaced;
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const Obstacle& o = s.obstacles[k];
    if (!o.motion || o.motion->kind != MotionKind::file) continue;
    displaced.push_back(displaced_text(s, k));
    const double lever =
        kDegree * (size_of(s, o) + length(o.motion->pivot.value_or(o.middle()) - o.middle()));
    std::vector<double> lengths{1, 1, 1, lever, lever, lever};
    lengths.resize(std::size_t(o.motion->table.columns));
    texts.push_back(
        table_text(named(s, k), o.motion->table, {"x", "y", "z", "rx", "ry", "rz"}, lengths, s));
  }
  if (s.tank_motion && s.tank_motion->kind == TankMotionKind::file &&
      s.tank_motion->table.columns == 1)
    texts.push_back(table_text("tank_motion", s.tank_motion->table, {"angle"},
                               {kDegree * length(s.domain.max - s.domain.min)}, s));
  std::erase(texts, "");
  std::erase(displaced, "");
  std::string text = first_of(displaced, kShown);
  if (!texts.empty())
    text += (text.empty() ? "" : "; ") + first_of(texts, kShown) +
            "; give more rows: every few steps, and a second one just after a stop and just before "
            "a start";
  return text;
}

}  // namespace pbf::run_module
