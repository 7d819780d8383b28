// Compares two run files: their metadata, then frame by frame.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/scene/load.h"
#include "lib/verify/compare_parts.h"

namespace pbf::verify_module {
namespace {

std::string side_of(const ComparedRun& o) {
  std::string s = fmt::format("{}: {}:{}", o.path, o.info.solver.backend, o.info.solver.precision);
  if (o.info.solver.threads > 0) s += fmt::format("@{}", o.info.solver.threads);
  return fmt::format("{}, version {} ({}), {} particles, {} frames, {}", s, o.info.program_version,
                     o.info.commit, o.info.particles, o.times.size(), o.end_text());
}

/// The scene without keys that do not affect the physics.
Scene physics_of(Scene s) {
  s.name.clear();
  s.backend = Backend::cpu;
  s.precision = Precision::dbl;
  s.threads = 0;
  if (!s.time.adaptive) s.measure_every = 1;  // otherwise measurements choose the step
  s.output.reset();
  s.render.reset();
  s.checkpoint.reset();
  s.time.end = 1;  // ignored here: the extent is compared separately
  s.solver.fused = true;
  return s;
}

ComparePart compare_scenes(const ComparedRun& a, const ComparedRun& b) {
  ComparePart p;
  p.name = "scene";
  p.tolerance_source = "every key that the physics depends on must be the same";
  const Scene x = physics_of(a.scene), y = physics_of(b.scene);
  p.verdict = x == y ? Verdict::same : Verdict::differs;
  const std::vector<std::string> found =
      differences(scene_table(), object(x), object(y), Effect::none, {"in A", "in B"});
  p.finding = x == y          ? "the same physics"
              : found.empty() ? "values that are written alike"
                              : joined(found, "; ");
  return p;
}

/// Whether identical bits are promised: CPU, same precision, same build.
bool same_bits(const RunInfo& a, const RunInfo& b) {
  return a.solver.backend == "cpu" && b.solver.backend == "cpu" &&
         a.solver.precision == b.solver.precision && a.commit == b.commit &&
         a.compiler == b.compiler && a.build_flags == b.build_flags;
}

struct LogEnd {
  std::size_t rows = 0;
  double time = 0, update = 0;
};
LogEnd log_end(const ComparedRun& r) {
  const std::vector<double> time = r.reader.log_column("time"),
                            update = r.reader.log_column("update");
  const std::size_t n = std::min(time.size(), update.size());
  return n == 0 ? LogEnd{} : LogEnd{n, time[n - 1], update[n - 1]};
}

std::string every_text(const Scene& s) {
  return s.output ? fmt::format("{:g} s", s.output->every) : std::string("off");
}

std::string one_sided(const char* of, const char* none, const std::vector<double>& times) {
  return fmt::format("{} frame{} of {} {} no frame of {} at {} time, the first at {:g} s",
                     times.size(), times.size() == 1 ? "" : "s", of,
                     times.size() == 1 ? "has" : "have", none, times.size() == 1 ? "its" : "their",
                     times.front());
}

/// Names in `x` that are missing in `y`.
std::vector<std::string> missing(const std::vector<std::string>& x,
                                 const std::vector<std::string>& y) {
  std::vector<std::string> out;
  for (const std::string& name : x)
    if (std::ranges::find(y, name) == y.end()) out.push_back(name);
  return out;
}

/// Compares metadata: status, end, frames, fields, rows of the log. Anything in only one of the
/// files is a difference.
ComparePart compare_extents(const ComparedRun& a, const ComparedRun& b, const FramePairs& frames) {
  std::vector<std::string> found;
  if (a.status != b.status) found.push_back("A is " + a.end_text() + ", B is " + b.end_text());
  if (a.scene.time.end != b.scene.time.end)
    found.push_back(
        fmt::format("time.end is {:g} s in A, {:g} s in B", a.scene.time.end, b.scene.time.end));
  if (!frames.only_a.empty()) found.push_back(one_sided("A", "B", frames.only_a));
  if (!frames.only_b.empty()) found.push_back(one_sided("B", "A", frames.only_b));
  if ((!frames.only_a.empty() || !frames.only_b.empty()) &&
      every_text(a.scene) != every_text(b.scene))
    found.push_back("output.every is " + every_text(a.scene) + " in A, " + every_text(b.scene) +
                    " in B");
  const LogEnd x = log_end(a), y = log_end(b);
  const double half = 0.5 * std::min(a.scene.time.step, b.scene.time.step);
  if (!(std::fabs(x.time - y.time) <= half) || (x.rows == 0) != (y.rows == 0))
    found.push_back(fmt::format(
        "the log ends at {:g} s (update {:g}, row {}) in A, {:g} s (update {:g}, row {}) in B",
        x.time, x.update, x.rows, y.time, y.update, y.rows));
  else if (x.rows != y.rows && a.scene.measure_every == b.scene.measure_every)
    found.push_back(fmt::format("the log has {} rows in A, {} in B", x.rows, y.rows));
  const std::vector<std::string> in_a = a.reader.fields(), in_b = b.reader.fields();
  if (!a.times.empty() && !b.times.empty())
    for (const auto& [names, with, without] :
         {std::tuple{missing(in_a, in_b), "A", &b}, std::tuple{missing(in_b, in_a), "B", &a}})
      for (const std::string& name : names)
        found.push_back("only " + std::string(with) + " has the field " + name + ", " +
                        without->path + " has not (output.fields writes it)");
  ComparePart p;
  p.name = "extent";
  p.tolerance_source = "none: what one file holds the other must hold too";
  p.verdict = found.empty() ? Verdict::same : Verdict::differs;
  for (const std::string& f : found) p.finding += (p.finding.empty() ? "" : "; ") + f;
  if (found.empty())
    p.finding = fmt::format("both are {}, with {} frames and {} rows of the log to {:g} s",
                            a.end_text(), a.times.size(), x.rows, x.time);
  return p;
}

void note_fields(CompareResult& result, const ComparedRun& a, const ComparedRun& b) {
  const auto x = a.reader.fields(), y = b.reader.fields();
  for (const char* name : {"velocity", "density"})
    if (std::ranges::find(x, name) == x.end() && std::ranges::find(y, name) == y.end())
      result.notes.push_back(std::string("neither file has the field ") + name +
                             ": what needs it is not compared (output.fields writes it)");
}

}  // namespace

ComparedRun::ComparedRun(const std::string& p)
    : path(p),
      reader((try_run_file(p), p)),
      info(reader.info()),
      scene(parse_stored_scene(info.resolved_scene, p + " (the scene stored in it)", {})),
      times(reader.times()),
      status(reader.status()) {}

std::string ComparedRun::end_text() const {
  const std::vector<RunSession> sessions = reader.sessions();
  if (status == "running") return "running (or killed)";
  if (sessions.empty() || sessions.back().reason.empty() || sessions.back().reason == status)
    return status;
  return status + " (" + sessions.back().reason + ")";
}

Snapshot ComparedRun::frame(std::int64_t k) const {
  Snapshot s = reader.frame(k);
  const std::tuple<const char*, int, bool> known[] = {
      {"position", 3, false}, {"velocity", 3, false}, {"density", 1, false}, {"id", 1, true}};
  for (const FieldArray& f : s.fields)
    for (const auto& [name, components, whole] : known)
      if (f.name == name && (f.components != components || is_whole(f.type) != whole))
        throw Error(ExitCode::io, path + ": frame " + std::to_string(k) + ": " + name +
                                      " has not the type and the columns that pbf writes");
  const std::vector<std::int64_t> id = ids_of(s);
  if (std::ranges::adjacent_find(id, std::greater_equal<>()) != id.end())
    throw Error(ExitCode::io, path + ": frame " + std::to_string(k) + ": ids do not ascend");
  return s;
}

FramePairs pair_times(const std::vector<double>& a, const std::vector<double>& b, double apart) {
  FramePairs out;
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (std::fabs(a[i] - b[k]) <= apart)
      out.common.emplace_back(i++, k++);
    else if (a[i] < b[k])
      out.only_a.push_back(a[i++]);
    else
      out.only_b.push_back(b[k++]);
  }
  out.only_a.insert(out.only_a.end(), a.begin() + std::ptrdiff_t(i), a.end());
  out.only_b.insert(out.only_b.end(), b.begin() + std::ptrdiff_t(k), b.end());
  return out;
}

FramePairs pair_frames(const ComparedRun& a, const ComparedRun& b) {
  return pair_times(a.times, b.times, 0.5 * std::min(a.scene.time.step, b.scene.time.step));
}

CompareResult compare_files(const std::string& path_a, const std::string& path_b) {
  const ComparedRun a(path_a), b(path_b);
  CompareResult result;
  result.a = side_of(a);
  result.b = side_of(b);
  const FramePairs frames = pair_frames(a, b);
  if (a.times.empty() && b.times.empty())
    throw Error(ExitCode::bad_input, path_a + " and " + path_b +
                                         " hold no frames to compare; run both scenes with an "
                                         "output block (--set output={})");
  if (frames.common.empty() && !a.times.empty() && !b.times.empty())
    throw Error(ExitCode::bad_input,
                path_a + " and " + path_b + " have no frame at the same time (" +
                    std::to_string(a.times.size()) + " and " + std::to_string(b.times.size()) +
                    " frames); run both scenes with the same output.every");
  std::error_code ignored;
  if (std::filesystem::equivalent(path_a, path_b, ignored))
    result.notes.push_back("A and B are one and the same file");
  note_fields(result, a, b);
  result.parts.push_back(compare_scenes(a, b));
  const bool same_scene = result.parts[0].verdict == Verdict::same;
  result.parts.push_back(compare_extents(a, b, frames));
  if (frames.common.empty()) return result;
  const bool exact = same_scene && same_bits(a.info, b.info);
  for (ComparePart& p : compare_frames(a, b, frames, exact, result))
    result.parts.push_back(std::move(p));
  if (auto bodies = compare_bodies(a, b, frames, exact)) result.parts.push_back(std::move(*bodies));
  return result;
}

}  // namespace pbf::verify_module
