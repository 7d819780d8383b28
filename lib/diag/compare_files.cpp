// Two run files: what they say about themselves, then frame by frame.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/diag/compare_parts.h"
#include "lib/diag/statistics.h"
#include "lib/io/run_file.h"
#include "lib/scene/load.h"

namespace pbf {
namespace {

struct Opened {
  std::string path;
  RunReader reader;
  RunInfo info;
  Scene scene;
  std::vector<double> times;
  explicit Opened(const std::string& p)
      : path(p),
        reader((try_run_file(p), p)),
        info(reader.info()),
        scene(parse_scene(info.resolved_scene, p + " (the scene stored in it)", {})),
        times(reader.times()) {}
};

std::string side_of(const Opened& o) {
  std::string s = o.path + ": " + o.info.solver.backend + ":" + o.info.solver.precision;
  if (o.info.solver.threads > 0) s += format("@%d", o.info.solver.threads);
  return s + ", version " + o.info.program_version + " (" + o.info.commit + ")" +
         format(", %lld particles, %zu frames, %s", static_cast<long long>(o.info.particles),
                o.times.size(), o.reader.status().c_str());
}

/// The scene without what does not touch the physics.
Scene physics_of(Scene s) {
  s.name.clear();
  s.backend = Backend::cpu;
  s.precision = Precision::dbl;
  s.threads = 0;
  s.measure_every = 1;
  s.output.reset();
  s.render.reset();
  s.checkpoint.reset();
  s.time.end = s.time.step;
  s.solver.fused = true;
  return s;
}

/// Lines that stand in one of two texts only.
std::string line_differences(const std::string& a, const std::string& b) {
  const auto lines = [](const std::string& text) {
    std::set<std::string> out;
    std::istringstream in(text);
    for (std::string l; std::getline(in, l);) out.insert(l.substr(0, l.find('#')));
    return out;
  };
  const auto trimmed = [](const std::string& l) { return l.substr(l.find_first_not_of(' ')); };
  const std::set<std::string> x = lines(a), y = lines(b);
  std::string out;
  for (const auto& l : x)
    if (!y.count(l)) out += (out.empty() ? "A " : "; A ") + trimmed(l);
  for (const auto& l : y)
    if (!x.count(l)) out += "; B " + trimmed(l);
  return out;
}

ComparePart compare_scenes(const Opened& a, const Opened& b) {
  ComparePart p;
  p.name = "scene";
  p.tolerance_source = "every key that the physics depends on must be the same";
  const Scene x = physics_of(a.scene), y = physics_of(b.scene);
  p.verdict = x == y ? Verdict::same : Verdict::differs;
  p.finding = x == y ? "the same physics" : line_differences(resolved_yaml(x), resolved_yaml(y));
  return p;
}

/// The same bits are promised: CPU, one precision, one build.
bool same_bits(const RunInfo& a, const RunInfo& b) {
  return a.solver.backend == "cpu" && b.solver.backend == "cpu" &&
         a.solver.precision == b.solver.precision && a.commit == b.commit &&
         a.compiler == b.compiler && a.build_flags == b.build_flags;
}

/// Frames of A and B at the same time, to half an update.
std::vector<std::pair<std::int64_t, std::int64_t>> common_frames(const Opened& a, const Opened& b) {
  std::vector<std::pair<std::int64_t, std::int64_t>> out;
  const double half = 0.5 * std::min(a.scene.time.step, b.scene.time.step);
  for (std::size_t i = 0, k = 0; i < a.times.size() && k < b.times.size();) {
    if (std::fabs(a.times[i] - b.times[k]) <= half)
      out.emplace_back(i++, k++);
    else
      a.times[i] < b.times[k] ? ++i : ++k;
  }
  return out;
}

std::vector<double> numbers_of(const FieldArray& f) {
  if (f.type == ScalarType::f64) return {f.as<double>().begin(), f.as<double>().end()};
  return {f.as<float>().begin(), f.as<float>().end()};
}

struct Distance {
  double rms = 0, worst = 0;
};
Distance distance(const Snapshot& a, const Snapshot& b) {
  const std::vector<double> x = numbers_of(a.fields[0]), y = numbers_of(b.fields[0]);
  Distance d;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    double r2 = 0;
    for (std::size_t k = i; k < i + 3; ++k) r2 += (x[k] - y[k]) * (x[k] - y[k]);
    d.worst = std::max(d.worst, std::sqrt(r2));
    d.rms += r2;
  }
  d.rms = std::sqrt(d.rms / double(std::max<std::size_t>(a.count, 1)));
  return d;
}

bool same_bytes(const Snapshot& a, const Snapshot& b) {
  for (const FieldArray& f : a.fields)
    if (const FieldArray* g = b.find(f.name); g && g->type == f.type && g->bytes != f.bytes)
      return false;
  return true;
}

/// The row of a name, made when new.
CompareRow& row_of(ComparePart& p, const std::string& what, const std::string& unit) {
  for (CompareRow& r : p.rows)
    if (r.what == what) return r;
  p.rows.push_back({what, unit, -1, 0, 0, 0, 0, Verdict::same});
  return p.rows.back();
}

void note(ComparePart& p, const std::string& what, const std::string& unit, double error,
          double scale, double tolerance) {
  CompareRow& r = row_of(p, what, unit);
  const double share = error == 0 ? 0 : error / tolerance;
  const double before = r.error < 0 ? -1 : r.error == 0 ? 0 : r.error / r.tolerance;
  if (!(share <= before)) {
    r.error = error;
    r.relative = scale > 0 ? error / scale : error;
    r.tolerance = tolerance;
  }
  if (!(error <= tolerance)) r.verdict = p.verdict = Verdict::differs;
}

constexpr double kAlpha = 1e-6;  // of a false alarm of one Kolmogorov-Smirnov test

void compare_samples(ComparePart& p, const FrameStatistics& a, const FrameStatistics& b) {
  for (const Statistic& x : a.numbers)
    for (const Statistic& y : b.numbers)
      if (x.name == y.name)
        note(p, x.name, x.unit, std::fabs(x.value - y.value),
             std::max(std::fabs(x.value), std::fabs(y.value)),
             std::hypot(x.uncertainty, y.uncertainty) +
                 0x1p-22 * std::max(std::fabs(x.value), std::fabs(y.value)));
  for (const Distribution& x : a.distributions)
    for (const Distribution& y : b.distributions)
      if (x.name == y.name)
        note(p, "distribution of " + x.name, "KS distance", ks_distance(x.values, y.values), 0,
             ks_critical(kAlpha, x.values.size(), y.values.size()));
}

void note_fields(CompareResult& result, const Opened& a, const Opened& b) {
  for (const char* name : {"velocity", "density"})
    for (const Opened* o : {&a, &b}) {
      const auto f = o->reader.fields();
      if (std::find(f.begin(), f.end(), name) == f.end())
        result.notes.push_back(o->path + " has no field " + name +
                               ": what needs it is not compared (output.fields writes it)");
    }
}

}  // namespace

CompareResult compare_files(const std::string& path_a, const std::string& path_b) {
  const Opened a(path_a), b(path_b);
  CompareResult result;
  result.a = side_of(a);
  result.b = side_of(b);
  const auto frames = common_frames(a, b);
  if (frames.empty())
    throw Error(ExitCode::bad_input,
                path_a + " and " + path_b + " have no frame at the same time (" +
                    std::to_string(a.times.size()) + " and " + std::to_string(b.times.size()) +
                    " frames); run both scenes with the same output.every");
  if (frames.size() < std::max(a.times.size(), b.times.size()))
    result.notes.push_back(
        format("%zu frames are at a time of both files (A has %zu, B %zu); "
               "the others are left out",
               frames.size(), a.times.size(), b.times.size()));
  note_fields(result, a, b);
  result.parts.push_back(compare_scenes(a, b));
  const bool same_scene = result.parts[0].verdict == Verdict::same;
  const bool exact = same_scene && same_bits(a.info, b.info);

  ComparePart near, far;
  near.name = "particles";
  far.name = "distributions";
  far.verdict = Verdict::same;
  far.tolerance_source = format(
      "two samples: %g standard errors of means and quantiles, Kolmogorov-Smirnov at %g; the "
      "worst frame counts",
      kSigmas, kAlpha);
  Curve rms{"A to B, rms", {}, {}}, worst{"A to B, largest", {}, {}};
  const double h = a.scene.h(), d = a.scene.fluid.spacing;
  bool paired = a.info.particles == b.info.particles, bytes = true;
  double last = 0;
  for (const auto& [i, k] : frames) {
    const Snapshot x = a.reader.frame(i), y = b.reader.frame(k);
    paired = paired && x.count == y.count;
    if (paired) {
      const Distance e = distance(x, y);
      bytes = bytes && same_bytes(x, y);
      last = e.rms / h;
      const double update = double(x.update);
      rms.x.push_back(update), rms.y.push_back(e.rms / h);
      worst.x.push_back(update), worst.y.push_back(e.worst / h);
      if (result.horizon < 0 && e.rms > 0.1 * d) result.horizon = update;
      if (x.update == 0) {
        // Written in float at worst: one rounding of a coordinate on each side.
        double largest = 0;
        for (const double v : numbers_of(x.fields[0])) largest = std::max(largest, std::fabs(v));
        note(near, "initial positions", "m", e.worst, largest, exact ? 0 : largest * 0x1p-22);
      }
    }
    const auto statistics = [&](const Opened& o, const Snapshot& s) {
      return frame_statistics(s, o.scene.domain.min, o.scene.gravity, o.scene.fluid.rest_density);
    };
    compare_samples(far, statistics(a, x), statistics(b, y));
  }
  if (!paired) {
    near.verdict = Verdict::differs;
    near.finding =
        format("A holds %lld particles, B %lld: no particle of one is one of the other",
               static_cast<long long>(a.info.particles), static_cast<long long>(b.info.particles));
    near.tolerance_source = "the numbers of particles must be the same";
  } else {
    result.e_folding = e_folding(rms.x, rms.y, 0.01);
    near.finding =
        bytes ? format("the %zu common frames are the same to the last byte", frames.size())
              : format("%.2g h apart (rms) at the last common frame", last);
    if (result.e_folding > 0)
      near.finding += format("; distances grow e-fold in %.3g updates", result.e_folding);
    if (result.horizon >= 0)
      near.finding += format("; not comparable from update %g on", result.horizon);
    if (exact) {
      near.tolerance_source = "0: both are the CPU in one precision and build, which promises it";
      near.verdict = bytes ? Verdict::same : Verdict::differs;
    } else {
      near.tolerance_source =
          "initial positions: one rounding; later distances are not judged, since files hold no "
          "ensemble (pbf compare SCENE --between makes one)";
      if (near.verdict != Verdict::differs)
        near.verdict = bytes ? Verdict::same : Verdict::not_judged;
    }
    result.diagrams.push_back(
        {"Distance of each particle in A and in B", "update", "h", {rms, worst}});
  }
  far.finding = far.verdict == Verdict::same ? "no two samples can be told apart"
                                             : "samples that are not of one distribution";
  result.parts.push_back(std::move(near));
  result.parts.push_back(std::move(far));
  return result;
}

}  // namespace pbf
