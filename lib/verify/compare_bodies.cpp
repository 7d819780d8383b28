// Compares where the free bodies of two runs are.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <span>

#include "lib/io/run_layout.h"
#include "lib/program/free_bodies.h"
#include "lib/verify/compare_parts.h"

namespace pbf::verify_module {
namespace {

/// A column of the poses of a body, over all times.
struct BodyRow {
  CompareRow row;
  double squares = 0, largest = 0;
  std::size_t times = 0;
  double worst_at = 0;  ///< s

  void take(std::span<const double> x, std::span<const double> y, double time) {
    double error = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      error = std::max(error, apart(x[k], y[k]));
      largest = std::max({largest, std::fabs(x[k]), std::fabs(y[k])});
    }
    squares += error * error;
    ++times;
    if (error > row.error) row.error = error, worst_at = time;
  }
};

std::string name_of(const ReadingColumn& c) {
  return std::string(c.kind) + "/" + c.of + (*c.name ? std::string(" ") + c.name : "");
}

/// The columns of one body, by their frames and by the log.
class ComparedBody {
 public:
  explicit ComparedBody(const std::string& name) : columns_(body_columns(name)) {
    for (const ReadingColumn& c : columns_)
      rows_.push_back({{name_of(c), c.unit, 0, 0, 0, 0, 0, Verdict::same}});
  }

  void take(const BodyMotion& x, const BodyMotion& y, double time) {
    std::vector<double> a, b;
    BodyMotion::each(x, [&](double v) { a.push_back(v); });
    BodyMotion::each(y, [&](double v) { b.push_back(v); });
    take(a, b, time);
  }

  void take_logs(const RunReader& a, const RunReader& b, double half) {
    std::vector<std::vector<double>> of_a, of_b;
    for_each_number(columns_, Series::poses, [&](const ReadingColumn& c, int k, std::size_t) {
      const std::string name = run_layout::further_column(c, k);
      of_a.push_back(a.log_column(name));
      of_b.push_back(b.log_column(name));
    });
    const std::vector<double> times = a.log_column("time");
    std::vector<double> x(of_a.size()), y(of_b.size());
    for (const auto& [i, k] : pair_times(times, b.log_column("time"), half).common) {
      for (std::size_t c = 0; c < of_a.size(); ++c) {
        if (std::size_t(i) >= of_a[c].size() || std::size_t(k) >= of_b[c].size()) return;
        x[c] = of_a[c][std::size_t(i)], y[c] = of_b[c][std::size_t(k)];
      }
      take(x, y, times[std::size_t(i)]);
    }
  }

  const std::vector<BodyRow>& rows() const { return rows_; }

 private:
  void take(const std::vector<double>& x, const std::vector<double>& y, double time) {
    std::size_t first = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const auto n = std::size_t(columns_[c].components);
      rows_[c].take(std::span(x).subspan(first, n), std::span(y).subspan(first, n), time);
      first += n;
    }
  }

  std::vector<ReadingColumn> columns_;
  std::vector<BodyRow> rows_;
};

}  // namespace

std::optional<ComparePart> compare_bodies(const ComparedRun& a, const ComparedRun& b,
                                          const FramePairs& frames, bool exact) {
  const std::vector<std::string> in_a = names_of_bodies(a.scene), in_b = names_of_bodies(b.scene);
  if (in_a.empty() && in_b.empty()) return {};
  ComparePart p;
  p.name = "bodies";
  p.verdict = Verdict::same;
  p.tolerance_source = exact
                           ? "0: both are the CPU in one precision and build, which promises it"
                           : "none: files hold no ensemble (pbf compare SCENE --between makes one)";
  std::vector<ComparedBody> bodies;
  for (const std::string& name : in_a) bodies.emplace_back(name);
  // Where B has a body of A; what only one has the part `scene` names.
  std::vector<std::size_t> at;
  for (const std::string& name : in_a)
    at.push_back(std::size_t(std::ranges::find(in_b, name) - in_b.begin()));
  for (const auto& [f, g] : frames.common) {
    const std::vector<BodyMotion> x = a.reader.bodies(f), y = b.reader.bodies(g);
    for (std::size_t i = 0; i < x.size() && i < bodies.size(); ++i)
      if (at[i] < y.size()) bodies[i].take(x[i], y[at[i]], a.times[std::size_t(f)]);
  }
  double worst = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (at[i] == in_b.size()) continue;
    ComparedBody& body = bodies[i];
    body.take_logs(a.reader, b.reader, 0.5 * std::min(a.scene.time.step, b.scene.time.step));
    for (const BodyRow& of : body.rows()) {
      CompareRow r = of.row;
      r.rms = std::sqrt(of.squares / double(std::max<std::size_t>(of.times, 1)));
      r.relative = of.largest > 0 ? r.error / of.largest : r.error;
      if (r.error > 0) r.verdict = p.verdict = exact ? Verdict::differs : Verdict::not_judged;
      if (&of == &body.rows()[0] && r.error > worst) {
        worst = r.error;
        p.finding = fmt::format("at {:g} s, {} is {:.2g} m from its place in the other run",
                                of.worst_at, in_a[i], worst);
      }
      p.rows.push_back(r);
    }
  }
  if (p.finding.empty())
    p.finding = p.verdict == Verdict::same ? "all are in the same places at all common times"
                                           : "they turn or move differently";
  return p;
}

}  // namespace pbf::verify_module
