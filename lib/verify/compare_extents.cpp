// The extent of two run files: status, end, frames, fields, rows of the log.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/verify/compare_run.h"

namespace pbf::verify_module {
namespace {

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
    if (std::find(y.begin(), y.end(), name) == y.end()) out.push_back(name);
  return out;
}

}  // namespace

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

}  // namespace pbf::verify_module
