// Compares two run files frame by frame: particles while they are comparable, samples always.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "lib/verify/compare_parts.h"
#include "lib/verify/statistics.h"

namespace pbf::verify_module {
namespace {

constexpr double kAlpha = 1e-6;  // false alarm rate of one Kolmogorov-Smirnov test

/// Differences up to this many roundings are ignored: both sides round in every update, and a
/// density sum has tens of terms.
constexpr double kRoundings = 16;

/// Resolution of a front, spacings. The top layer of a pool is flatter than a random sample, so
/// order statistics underestimate its uncertainty.
constexpr double kFront = 0.01;

/// Edge of the cells whose particles may move together, h: the range of interaction.
constexpr double kCluster = 2;

double largest_of(const FieldArray* f) {
  double largest = 0;
  if (f)
    for (const double v : numbers_of(*f))
      if (std::isfinite(v)) largest = std::max(largest, std::fabs(v));
  return largest;
}

/// Whether the bits are the same, after conversion to float if only one file holds double.
bool same_numbers(const FieldArray& f, const FieldArray& g) {
  if (f.type == g.type) return f.bytes == g.bytes;
  const std::vector<double> x = numbers_of(f), y = numbers_of(g);
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](double a, double b) {
    const float c = float(a), d = float(b);
    return std::memcmp(&c, &d, sizeof c) == 0;
  });
}
bool same_numbers(const Snapshot& a, const Snapshot& b) {
  for (const FieldArray& f : a.fields)
    if (const FieldArray* g = b.find(f.name); g && !is_whole(f.type) && !same_numbers(f, *g))
      return false;
  return true;
}

/// Particles that only one of two files has.
struct OneSided {
  bool allowed;          ///< by chaos, for the number of particles changes
  bool differs = false;  ///< some were there that are not allowed
  std::size_t most = 0;  ///< in a frame
  std::string where{};   ///< that frame; empty: none

  void take(const CommonRows& rows, const Snapshot& x, const Snapshot& y) {
    const std::size_t alone = rows.only_a + rows.only_b;
    differs = differs || (alone > 0 && (!allowed || (x.update == 0 && y.update == 0)));
    if (alone <= most) return;
    most = alone;
    where = fmt::format(
        "A holds {} particles at {:g} s, B {}: {} are in A alone, {} in B alone; "
        "of those in both: ",
        x.count, x.time, y.count, rows.only_a, rows.only_b);
  }
};

/// Particles that have come or gone since the first frame.
double changed_since(std::optional<std::vector<std::int64_t>>& first,
                     const std::vector<std::int64_t>& now) {
  if (!first) first = now;
  const CommonRows rows = common_rows(*first, now);
  return double(rows.only_a + rows.only_b);
}

double unit_roundoff(bool single) {
  return about(single ? Precision::single : Precision::dbl).roundoff;
}

/// Differences from rounding in two runs. Positions scale with the extent of the box, velocities
/// with moves per step, densities with sums over distances in h.
Resolution computed(const ComparedRun& a, const ComparedRun& b) {
  const double u =
      unit_roundoff(a.info.solver.precision == "float" || b.info.solver.precision == "float");
  double extent = 0, step = HUGE_VAL;
  for (const ComparedRun* o : {&a, &b}) {
    const Scene& s = o->scene;
    for (std::size_t k = 0; k < 3; ++k)
      extent = std::max(extent, s.domain.max[k] - s.domain.min[k]);
    step = std::min(step, s.time.step / s.solver.substeps);
    for (const double dt : o->reader.log_column("dt"))
      if (dt > 0) step = std::min(step, dt);
  }
  return {u * extent, u * extent / step, u * (1 + extent / std::min(a.scene.h(), b.scene.h())),
          kFront * std::min(a.scene.fluid.spacing, b.scene.fluid.spacing),
          kCluster * std::max(a.scene.h(), b.scene.h())};
}

/// Adds the rounding of the stored values.
Resolution resolution_of(const Resolution& computed, const Snapshot& x, const Snapshot& y,
                         double rest_density) {
  const auto stored = [&](const char* name) {
    double most = 0;
    for (const Snapshot* s : {&x, &y})
      if (const FieldArray* f = s->find(name))
        most = std::max(most, unit_roundoff(f->type == ScalarType::f32) * largest_of(f));
    return most;
  };
  return {kRoundings * (computed.length + stored("position")),
          kRoundings * (computed.speed + stored("velocity")),
          kRoundings * (computed.density + stored("density") / rest_density), computed.front,
          computed.cluster};
}

void compare_samples(ComparePart& p, const FrameStatistics& a, const FrameStatistics& b) {
  for (const Statistic& x : a.numbers)
    for (const Statistic& y : b.numbers)
      if (x.name == y.name) {
        const double open = std::hypot(x.uncertainty, y.uncertainty);
        note(p, x.name, x.unit, apart(x.value, y.value),
             std::max(std::fabs(x.value), std::fabs(y.value)),
             (std::isnan(open) ? 0 : open) + std::max(x.resolution, y.resolution));
      }
  for (const Distribution& x : a.distributions)
    for (const Distribution& y : b.distributions)
      if (x.name == y.name)
        note(p, "distribution of " + x.name, "KS distance",
             ks_distance(x.values, y.values, std::max(x.resolution, y.resolution)), 0,
             ks_critical(kAlpha, x.samples, y.samples));
}

/// Compares the numbers of values that are not finite, by field.
void compare_not_finite(ComparePart& p, const Snapshot& a, const Snapshot& b) {
  const auto count = [](const FieldArray& f) {
    double n = 0;
    for (const double v : numbers_of(f)) n += !std::isfinite(v);
    return n;
  };
  for (const FieldArray& f : a.fields)
    if (const FieldArray* g = b.find(f.name); g && !is_whole(f.type)) {
      const double x = count(f), y = count(*g);
      if (x > 0 || y > 0)
        note(p, "not finite: " + f.name, "values", std::fabs(x - y), std::max(x, y), 0);
    }
}

}  // namespace

std::vector<ComparePart> compare_frames(const ComparedRun& a, const ComparedRun& b,
                                        const FramePairs& frames, bool exact,
                                        CompareResult& result) {
  ComparePart near, far;
  near.name = "particles";
  far.name = "distributions";
  far.verdict = Verdict::same;
  far.tolerance_source = fmt::format(
      "two samples: {:g} standard errors of means and quantiles, Kolmogorov-Smirnov at {:g}, where "
      "values up to {:g} roundings apart are equal, fronts up to {:g} spacings; once particles are "
      "not comparable, of as many samples as velocity and density are independent in cells of {:g} "
      "to {:g} h; the worst frame counts",
      kSigmas, kAlpha, kRoundings, kFront, kCluster, 4 * kCluster);
  Curve rms{"A to B, rms", {}, {}}, worst{"A to B, largest", {}, {}};
  const double h = a.scene.h(), d = a.scene.fluid.spacing;
  bool bytes = true;
  double last = 0;
  OneSided one_sided{a.info.capacity > 0 && b.info.capacity > 0};
  std::optional<std::vector<std::int64_t>> first_a, first_b;
  const Resolution own = computed(a, b);
  for (const auto& [i, k] : frames.common) {
    const Snapshot x = a.frame(i), y = b.frame(k);
    Resolution resolution = resolution_of(own, x, y, a.scene.fluid.rest_density);
    const std::vector<std::int64_t> ids_a = ids_of(x), ids_b = ids_of(y);
    const CommonRows rows = common_rows(ids_a, ids_b);
    one_sided.take(rows, x, y);
    const auto places = [&](const Snapshot& s, const std::vector<std::size_t>& common) {
      const std::vector<double> all = numbers_of(s.fields[0]);
      return rows.all() ? all : rows_of(all, common, 3);
    };
    const Distance e = distance(places(x, rows.a), places(y, rows.b), periods(a.scene));
    bytes = bytes && rows.all() && same_numbers(x, y);
    last = e.rms / h;
    const double update = double(x.update);
    rms.x.push_back(update), rms.y.push_back(e.rms / h);
    worst.x.push_back(update), worst.y.push_back(e.worst / h);
    if (result.horizon < 0 && e.rms > 0.1 * d) result.horizon = update;
    if (x.update == 0 && y.update == 0)
      note(near, "initial positions", "m", e.worst, largest_of(&x.fields[0]),
           exact ? 0 : resolution.length);
    // Before the horizon both sides have the same particles; after it they are samples of a flow.
    resolution.mixed = result.horizon >= 0;
    const double changed =
        one_sided.allowed ? std::max(changed_since(first_a, ids_a), changed_since(first_b, ids_b))
                          : 0;
    if (x.count != y.count)
      note(far, "particles", "1", std::fabs(double(x.count) - double(y.count)),
           double(std::max(x.count, y.count)), kSigmas * std::sqrt(changed));
    compare_not_finite(far, x, y);
    const auto statistics = [&](const ComparedRun& o, const Snapshot& s) {
      return frame_statistics(s, o.scene.domain.min, o.scene.gravity, o.scene.fluid.rest_density,
                              resolution);
    };
    compare_samples(far, statistics(a, x), statistics(b, y));
  }
  result.e_folding = e_folding(rms.x, rms.y, 0.01);
  near.finding =
      bytes
          ? fmt::format("the {} common frames are the same to the last byte", frames.common.size())
          : one_sided.where + fmt::format("{:.2g} h apart (rms) at the last common frame", last);
  if (result.e_folding > 0)
    near.finding += fmt::format("; distances grow e-fold in {:.3g} updates", result.e_folding);
  if (result.horizon >= 0)
    near.finding += fmt::format("; not comparable from update {:g} on", result.horizon);
  if (exact) {
    near.tolerance_source = "0: both are the CPU in one precision and build, which promises it";
    near.verdict = bytes ? Verdict::same : Verdict::differs;
  } else {
    near.tolerance_source = fmt::format(
        "initial positions: {:g} roundings; later distances are not judged, since files hold no "
        "ensemble (pbf compare SCENE --between makes one)",
        kRoundings);
    // Steps without time that separate overlaps amplify rounding, as all steps do.
    const bool relieved = a.scene.solver.prestabilize && b.scene.solver.prestabilize;
    if (near.verdict == Verdict::differs && relieved) {
      near.verdict = near.rows[0].verdict = Verdict::not_judged;
      near.finding +=
          "; the start differs by more than rounding, which steps without time "
          "(solver.prestabilize) may do: the samples judge it";
    }
    if (one_sided.differs) {
      near.verdict = Verdict::differs;
      near.tolerance_source += one_sided.allowed ? "; the particles of the start must be the same"
                                                 : "; the particles must be the same";
    }
    if (near.verdict != Verdict::differs)
      near.verdict = bytes ? Verdict::same : Verdict::not_judged;
  }
  result.diagrams.push_back(
      {"Distance of each particle in A and in B", "update", "h", {rms, worst}});
  far.finding = far.verdict == Verdict::same ? "no two samples can be told apart"
                                             : "samples that are not of one distribution";
  return {std::move(near), std::move(far)};
}

}  // namespace pbf::verify_module
