#include "lib/run/motion_files.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/io/csv.h"
#include "lib/program/motion.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/number.h"
#include "lib/scene/validate.h"

namespace pbf::run_module {
namespace {

namespace fs = std::filesystem;

class Reader {
 public:
  /// `key`: the key with its place in the scene file.
  Reader(const Scene& scene, std::string key, std::string file)
      : s_(scene), key_(std::move(key)), file_(std::move(file)) {}

  /// `headers`: the allowed ones.
  MotionTable read(const std::vector<std::string>& headers) const {
    MotionTable t;
    const std::vector<CsvRow> rows = all_rows(t.sha256);
    std::string header;
    std::size_t columns = rows.empty() ? 0 : rows[0].cells.size();
    while (columns > 4 && rows[0].cells[columns - 1].starts_with("eta_")) --columns;
    for (std::size_t c = 0; c < columns; ++c) header += (c == 0 ? "" : ",") + rows[0].cells[c];
    if (std::ranges::find(headers, header) == headers.end())
      fail(rows.empty() ? file_ : rows[0].where,
           (rows.empty() ? "is empty" : wrong_header(header)) + ", expected the header " +
               joined(headers, " or "));
    t.file = fs::absolute(file_).string();
    t.columns = int(columns) - 1;
    for (std::size_t r = 1; r < rows.size(); ++r) {
      std::array<double, 6> values{};
      double time = 0;
      for (std::size_t c = 0; c < columns; ++c)
        number(rows[r], rows[0].cells[c], c, c == 0 ? time : values[c - 1]);
      if (!t.time.empty() && !(time > t.time.back()))
        fail(rows[r].where, "time " + rows[r].cells[0] + " does not follow " +
                                rows[r - 1].cells[0] + "; times must grow");
      if (s_.dimensions == 2) must_lie_flat(rows[0], rows[r], values);
      t.time.push_back(time);
      t.values.push_back(values);
      t.line.push_back(rows[r].line);
    }
    if (t.time.size() < 2) fail(file_, "needs at least two rows of numbers below the header");
    return t;
  }
  void covers_run(const MotionTable& t) const {
    const double begin = s_.time.motion_begin;
    covers(t, begin, begin + s_.time.end, "the run", "time.end");
  }
  /// Refuses a table of speeds that goes backwards, or does not last from start to end.
  void check(const MotionTable& t, const Emitter& e) const {
    for (std::size_t k = 0; k < t.time.size(); ++k)
      if (!(t.values[k][0] >= 0 && t.values[k][0] <= 1e6))
        fail(file_ + ":" + std::to_string(t.line[k]),
             fmt::format("V: is {:.6g} m/s, must be from 0 to 1e6", t.values[k][0]));
    const double end = std::min(e.end.value_or(s_.time.end), s_.time.end);
    if (end > e.start) covers(t, e.start, end, "the emitter", "end");
  }
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    bad_input(key_, where + ": " + what);
  }

 private:
  void covers(const MotionTable& t, double from, double to, const char* what,
              const char* key) const {
    const double slack = 1e-9 * s_.time.end;
    if (t.time.front() > from + slack || t.time.back() < to - slack)
      fail(file_, fmt::format("goes from {:.6g} to {:.6g} s, {} from {:.6g} to {:.6g} s; give "
                              "a table that lasts as long, or another {}",
                              t.time.front(), t.time.back(), what, from, to, key));
  }
  std::vector<CsvRow> all_rows(std::string& sha256) const {
    try {
      return read_csv(file_, "", &sha256);
    } catch (const Error& e) {
      throw Error(e.code(), key_ + ": " + e.what() +
                                (e.code() == ExitCode::io && !fs::exists(file_)
                                     ? "; its path counts from the folder of the scene file"
                                     : ""));
    }
  }
  void number(const CsvRow& row, const std::string& name, std::size_t c, double& out) const {
    if (read_number(row.cells[c], out) != NumberError::none || !std::isfinite(out))
      fail(row.where, name + ": \"" + row.cells[c].substr(0, 40) + "\" is not a number");
  }
  /// In two dimensions only x, z and rotation about y may differ from 0.
  void must_lie_flat(const CsvRow& header, const CsvRow& row,
                     const std::array<double, 6>& values) const {
    for (const char* name : {"y", "ay", "rx", "rz"})
      for (std::size_t c = 1; c < std::min<std::size_t>(row.cells.size(), 7); ++c)
        if (header.cells[c] == name && values[c - 1] != 0)
          fail(row.where,
               std::string(name) + " is " + row.cells[c] + ", with dimensions: 2 it must be 0");
  }

  const Scene& s_;
  std::string key_, file_;
};

// ------------------------------------------------------------ time.step: auto, with motions

/// The largest f(scene, from, to) of a motion, over its ramp and one period, or over its table; s
/// since the start. The scene has a time step that is short enough to sample speeds and
/// accelerations: an oscillation averages out over a long step.
template <class AnyMotion, class F>
double largest(Scene s, const AnyMotion& m, F&& f) {
  using Kind = decltype(m.kind);
  const bool swings = m.kind == Kind::sine;
  const double begin = s.time.motion_begin;
  double step = s.time.step, end = 0;
  const double ramp = m.ramp.value_or(0);
  if (swings) step = std::min(step, m.period / 256), end = std::max(0.0, ramp - begin) + m.period;
  if (swings && ramp > 0) step = std::min(step, ramp / 256);
  for (std::size_t k = 1; k < m.table.time.size(); ++k)
    step = std::min(step, (m.table.time[k] - m.table.time[k - 1]) / 16);
  if (!m.table.time.empty()) end = std::max(0.0, m.table.time.back() - begin);
  s.time.step = std::max(step, 1e-4 * s.time.step);  // below this, differences are rounding
  return f(s, 0.0, end);
}

/// Greatest speed of an obstacle at any time, m/s; of a free body that at the start.
double fastest_ever(const Scene& s) {
  double most = 0;
  Scene one = s;  // obstacles have different periods
  for (const Obstacle& o : s.obstacles) {
    one.obstacles = {o};
    most = std::max(
        most, o.motion ? largest(one, *o.motion, fastest_obstacle) : fastest_obstacle(one, 0, 0));
  }
  return most;
}

/// Greatest acceleration that a particle at rest feels in the tank at any time, m/s^2.
double greatest_pull_ever(const Scene& s) {
  return s.tank_motion ? largest(s, *s.tank_motion, greatest_pull) : greatest_pull(s, 0, 0);
}

double longest_of(const Scene& s) {
  double longest = step_rule(s).longest();
  if (const double pull = greatest_pull_ever(s); pull > 0)
    longest = std::min(longest, kSafeStep * std::sqrt(s.h() / pull));
  if (const double speed = fastest_ever(s); speed > 0)
    longest = std::min(longest, kSafeWay * s.h() / speed);
  return longest;
}

}  // namespace

void read_motion(const Scene& scene, Motion& m, const std::string& key, const std::string& file) {
  const Reader reader(scene, key, file);
  m.table = reader.read({"t,x,y,z", "t,x,y,z,rx,ry,rz"});
  reader.covers_run(m.table);
}
void read_motion(const Scene& scene, TankMotion& m, const std::string& key,
                 const std::string& file) {
  const Reader reader(scene, key, file);
  m.table = reader.read({"t,angle", "t,ax,ay,az"});
  if ((m.table.columns == 1) != m.axis.has_value())
    reader.fail(m.table.file, m.axis ? "holds accelerations, which have no axis; remove "
                                       "tank_motion.axis"
                                     : "holds angles; give tank_motion.axis");
  reader.covers_run(m.table);
}
void read_motion(const Scene& scene, Emitter& e, const std::string& key, const std::string& file) {
  const Reader reader(scene, key, file);
  e.table = reader.read({"t,V"});
  reader.check(e.table, e);
}

void choose_step_of_motions(Scene& scene) {
  const bool speeds =
      std::ranges::any_of(scene.emitters, [](const Emitter& e) { return !e.path.empty(); });
  if (!has_motion(scene) && !speeds) return;
  // Speeds and accelerations are means over a step, so a shorter step may show larger ones.
  for (int k = 0; k < 8; ++k) {
    const double before = scene.time.step, step = fitted_step(scene, longest_of(scene));
    if (step == 0)
      bad_input("time.step",
                "auto goes by gravity, the velocities of bodies and motions, and nothing moves; "
                "give a number");
    scene.time.step = step;
    if (k > 0 && step >= before) break;
  }
  PlacedScene placed;
  placed.scene = scene;
  placed.places[""] = "time.step: auto";
  Problems problems;
  check_scene(placed, problems);
  problems.raise();
}

}  // namespace pbf::run_module
