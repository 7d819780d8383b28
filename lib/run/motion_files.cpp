#include "lib/run/motion_files.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/io/csv.h"
#include "lib/scene/number.h"

namespace pbf::run_module {
namespace {

namespace fs = std::filesystem;

/// Calls f(motion, key) for every motion that is read from a file. Scene may be const.
template <class AnyScene, class F>
void for_each_file(AnyScene& s, F&& f) {
  for (std::size_t k = 0; k < s.obstacles.size(); ++k)
    if (auto& m = s.obstacles[k].motion; m && m->kind == MotionKind::file)
      f(*m, "obstacles[" + std::to_string(k) + "].motion.path");
  if (auto& m = s.tank_motion; m && m->kind == TankMotionKind::file)
    f(*m, std::string("tank_motion.path"));
}

class Reader {
 public:
  /// `key`: the key with its place in the scene file.
  Reader(const Scene& scene, std::string key, std::string file)
      : s_(scene), key_(std::move(key)), file_(std::move(file)) {}

  /// `headers`: the allowed ones.
  MotionTable read(const std::vector<std::string>& headers) {
    MotionTable t;
    const std::vector<CsvRow> rows = all_rows(t.sha256);
    std::string header;
    if (!rows.empty())
      for (const std::string& cell : rows[0].cells) header += (header.empty() ? "" : ",") + cell;
    if (std::find(headers.begin(), headers.end(), header) == headers.end())
      fail(rows.empty() ? file_ : rows[0].where,
           (rows.empty() ? "is empty" : wrong_header(header)) + ", expected the header " +
               headers[0] + " or " + headers[1]);
    t.file = fs::absolute(file_).string();
    t.columns = int(rows[0].cells.size()) - 1;
    for (std::size_t r = 1; r < rows.size(); ++r) {
      std::array<double, 6> values{};
      double time = 0;
      for (std::size_t c = 0; c < rows[r].cells.size(); ++c)
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
    const double from = s_.time.motion_begin, to = from + s_.time.end, slack = 1e-9 * s_.time.end;
    if (t.time.front() > from + slack || t.time.back() < to - slack)
      fail(file_, fmt::format("goes from {:.6g} to {:.6g} s, the run from {:.6g} to {:.6g} s; give "
                              "a table that lasts as long, or another time.end",
                              t.time.front(), t.time.back(), from, to));
    return t;
  }
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    bad_input(key_, where + ": " + what);
  }

 private:
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
      for (std::size_t c = 1; c < row.cells.size(); ++c)
        if (header.cells[c] == name && values[c - 1] != 0)
          fail(row.where,
               std::string(name) + " is " + row.cells[c] + ", with dimensions: 2 it must be 0");
  }

  const Scene& s_;
  std::string key_, file_;
};

}  // namespace

void read_motions(Scene& scene, const std::string& dir, bool auto_step) {
  for_each_file(scene, [&](auto& m, const std::string& key) {
    const std::string place = m.place.text.empty() ? "" : m.place.text + ": ";
    Reader reader(scene, place + key, (fs::path(dir) / m.path).string());
    if constexpr (std::is_same_v<std::decay_t<decltype(m)>, Motion>) {
      m.table = reader.read({"t,x,y,z", "t,x,y,z,rx,ry,rz"});
    } else {
      m.table = reader.read({"t,angle", "t,ax,ay,az"});
      if ((m.table.columns == 1) != m.axis.has_value())
        reader.fail(m.table.file, m.axis ? "holds accelerations, which have no axis; remove "
                                           "tank_motion.axis"
                                         : "holds angles; give tank_motion.axis");
    }
  });
  if (auto_step) choose_step_of_motions(scene);
}

std::vector<std::string> motion_paths(const Scene& scene) {
  std::vector<std::string> all;
  for_each_file(scene, [&](const auto& m, const std::string&) { all.push_back(m.path); });
  return all;
}

std::vector<SceneFile> motion_files(const Scene& scene) {
  std::vector<SceneFile> files;
  for_each_file(scene, [&](const auto& m, const std::string&) {
    files.push_back({m.path, m.table.sha256});
  });
  return files;
}

void make_paths_absolute(Scene& scene) {
  for_each_file(scene, [](auto& m, const std::string&) { m.path = m.table.file; });
}

}  // namespace pbf::run_module
