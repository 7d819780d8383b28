// The updates after the frozen step: distances between particles, and statistics.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "lib/run/session.h"
#include "lib/verify/compare_parts.h"
#include "lib/verify/statistics.h"

namespace pbf::verify_module {
namespace {

/// In order of ids, h.
std::vector<double> positions(Solver& solver) { return solver.state(StateOf::positions).position; }

/// Infinite if a position is not finite, also on both sides.
Distance strict_distance(const std::vector<double>& x, const std::vector<double>& y,
                         const Double3& period) {
  const Distance d = distance(x, y, period, [](double a, double b) { return a - b; });
  return std::isnan(d.rms) ? Distance{HUGE_VAL, HUGE_VAL} : d;
}

class Samples {
 public:
  explicit Samples(const Comparison& c) : c_(c) {
    part_.name = "distributions";
    part_.verdict = Verdict::same;
    part_.tolerance_source =
        c.same_bits ? "0: both sides promise the same bits"
                    : fmt::format(
                          "{:g} x the largest change so far over the {} randomly rounded "
                          "references (what chaos alone makes), + (4 + steps) u |value| (of a "
                          "momentum: of the mean speed; of a force: of the peak) or two particles; "
                          "of loads and gauges what their whole numbers leave open",
                          kSpreadFactor, c.members.size());
  }
  std::int64_t first_failure = -1;  ///< update of the first sample outside a tolerance

  /// `update`: counted from the frozen step.
  void take(std::int64_t update) {
    update_ = update;
    // Random rounding averages out over the particles, but real rounding may be biased, e.g. if a
    // slow particle moves by less than the last place of its position in every substep.
    const double roundings = 4 + double(update * c_.plan->substeps);
    const FrameStatistics a = of(*c_.a), b = of(*c_.b);
    FrameStatistics r;
    std::vector<FrameStatistics> members;
    if (!c_.same_bits) {
      r = of(*c_.reference);
      for (const auto& m : c_.members) members.push_back(of(*m));
    }
    for (std::size_t k = 0; k < a.numbers.size(); ++k) {
      double spread = 0;
      for (const auto& m : members)
        spread = std::max(spread, std::fabs(m.numbers[k].value - r.numbers[k].value));
      const double scale = std::max(
          {std::fabs(a.numbers[k].value), std::fabs(b.numbers[k].value), a.numbers[k].scale});
      take(a.numbers[k].name, a.numbers[k].unit, std::fabs(a.numbers[k].value - b.numbers[k].value),
           scale, spread, roundings * c_.u * scale);
    }
    for (std::size_t k = 0; k < a.distributions.size(); ++k) {
      double spread = 0;
      for (const auto& m : members)
        spread =
            std::max(spread, ks_distance(m.distributions[k].values, r.distributions[k].values));
      // The distance changes in steps of one particle.
      const double one = 1 / double(a.distributions[k].values.size());
      take("distribution of " + a.distributions[k].name, "KS distance",
           ks_distance(a.distributions[k].values, b.distributions[k].values), 0, spread, 2 * one);
    }
    take_loads_and_gauges(roundings);
  }

  ComparePart part() const {
    ComparePart p = part_;
    double worst = 0;
    std::string name;
    for (const CompareRow& row : p.rows)
      if (const double share = share_of(row.error, row.tolerance); share >= worst)
        worst = share, name = row.what;
    p.finding = c_.same_bits
                    ? std::string(p.verdict == Verdict::same ? "all equal" : "not equal")
                    : fmt::format("the largest share of a tolerance is {:.2g} ({})", worst, name);
    return p;
  }

 private:
  FrameStatistics of(Solver& s) const {
    return frame_statistics(s.download({"velocity", "density"}, ScalarType::f64).get(),
                            c_.scene->domain.min, c_.scene->gravity, c_.scene->fluid.rest_density);
  }
  /// Readings over the interval since the last sample.
  void take_loads_and_gauges(double roundings) {
    const int updates = int(update_ - last_);
    last_ = update_;
    const std::vector<Reading> a = c_.take(*c_.a, updates), b = c_.take(*c_.b, updates);
    std::vector<double> spread;
    if (!c_.same_bits) {
      const std::vector<Reading> r = c_.take(*c_.reference, updates);
      for (const auto& m : c_.members) raise_to_distance(spread, c_.take(*m, updates), r);
    }
    for (std::size_t k = 0; k < a.size(); ++k)
      if (const Reading* y = find_reading(b, a[k].what)) {
        const double scale = scale_of(a[k], *y);
        take(a[k].what, a[k].unit, apart(a[k].value, y->value), scale, c_.same_bits ? 0 : spread[k],
             roundings * c_.u * scale + a[k].grain);
      }
  }
  void take(const std::string& what, const std::string& unit, double error, double scale,
            double spread, double floor) {
    double& widest = spread_[what];
    widest = std::max(widest, spread);
    const double tolerance = c_.same_bits ? 0 : c_.sides * (kSpreadFactor * widest + floor);
    if (!note(part_, what, unit, error, scale, tolerance, c_.u) && first_failure < 0)
      first_failure = update_;
  }

  const Comparison& c_;
  std::int64_t update_ = 0, last_ = 0;
  ComparePart part_;
  std::map<std::string, double> spread_;  ///< largest change over the ensemble so far
};

}  // namespace

std::vector<ComparePart> compare_course(const Comparison& c, const SolverState& start,
                                        CompareResult& result, std::int64_t& first_failure) {
  c.a->set_state(start);
  c.b->set_state(start);
  if (!c.same_bits) {
    c.reference->set_state(start);
    for (std::size_t m = 0; m < c.members.size(); ++m)
      c.members[m]->set_state(rounded(start, c.u, c.settings->seed + m));
  }
  Samples samples(c);
  Curve rms{"A to B, rms", {}, {}}, worst{"A to B, largest", {}, {}},
      chaos{"chaos alone, rms", {}, {}};
  ComparePart near;
  near.name = "short horizon";
  CompareRow row{"distance of a particle, rms", "h", 0, 0, 0, 0, 0, Verdict::same};
  const Double3 period = periods_in_h(*c.scene);
  const double apart = 0.1 / c.scene->fluid.smoothing_ratio;  // a tenth of the spacing, h
  double spread = 0, share = -1;
  first_failure = -1;
  const int updates = c.settings->updates, every = std::max(1, updates / 10);
  for (int t = 1; t <= updates; ++t) {
    advance(*c.a, 1);
    advance(*c.b, 1);
    const Distance d = strict_distance(positions(*c.a), positions(*c.b), period);
    double now = 0;
    if (!c.same_bits) {
      advance(*c.reference, 1);
      const std::vector<double> r = positions(*c.reference);
      for (std::size_t m = 0; m < c.members.size(); ++m) {
        // Different random rounding in every update.
        c.members[m]->inspection()->trace(
            {c.u, c.settings->seed + 1000 * std::uint64_t(t) + m, nullptr});
        now = std::max(now, strict_distance(positions(*c.members[m]), r, period).rms);
      }
      spread = std::max(spread, now);
    }
    rms.x.push_back(t), rms.y.push_back(d.rms);
    worst.x.push_back(t), worst.y.push_back(d.worst);
    chaos.x.push_back(t), chaos.y.push_back(now);
    if (result.horizon < 0 && d.rms > apart) result.horizon = t;
    const double tolerance = c.same_bits ? 0 : c.sides * kNoiseFactor * spread;
    // After the horizon, distances are those of unrelated particles: the third part applies.
    if (result.horizon < 0 || t == 1 || first_failure >= 0) {
      const double s = share_of(d.rms, tolerance);
      if (s > share) share = s, row.error = d.rms, row.rms = d.rms, row.tolerance = tolerance;
      if (s > 1 && first_failure < 0) first_failure = t;
    }
    if (t % every == 0 || t == updates) samples.take(t);
    if (c.progress && t % every == 0)
      c.progress(fmt::format("update {}/{}: particles {:.2g} h apart (rms)", t, updates, d.rms));
  }
  row.verdict = near.verdict = first_failure < 0 ? Verdict::same : Verdict::differs;
  row.relative = row.error;
  near.rows.push_back(row);
  near.tolerance_source = c.same_bits
                              ? "0: both sides promise the same bits"
                              : fmt::format(
                                    "{:g} x the largest rms distance so far of {} references, "
                                    "rounded at random in every update, from the one that is not",
                                    kNoiseFactor, c.members.size());
  // Skip the first updates, which are rounding, and stop at 0.01 h, where growth saturates.
  std::vector<double> x(rms.x.begin() + std::min<std::ptrdiff_t>(5, updates), rms.x.end());
  std::vector<double> y(rms.y.begin() + std::min<std::ptrdiff_t>(5, updates), rms.y.end());
  result.e_folding = e_folding(x, y, 0.01);
  const double last = rms.y.empty() ? 0 : rms.y.back();
  if (last == 0)
    near.finding = fmt::format("identical for {} updates", updates);
  else
    near.finding = fmt::format("{:.2g} h apart (rms) after {} updates", last, updates);
  if (result.e_folding > 0)
    near.finding += fmt::format("; distances grow e-fold in {:.3g} updates", result.e_folding);
  if (result.horizon >= 0)
    near.finding += fmt::format(
        "; from update {:g} on, a tenth of the spacing apart, particles are not comparable",
        result.horizon);
  else if (result.e_folding > 0 && last > 0)
    near.finding += fmt::format("; not comparable past about update {:.0f}",
                                updates + result.e_folding * std::log(apart / last));
  if (first_failure >= 0)
    near.finding += fmt::format("; outside the tolerance from update {} on", first_failure);
  if (first_failure < 0) first_failure = samples.first_failure;
  Diagram diagram{"Distance of each particle on A and on B", "update", "h", {rms, worst}};
  if (!c.same_bits) diagram.curves.push_back(chaos);
  result.diagrams.push_back(diagram);
  return {near, samples.part()};
}

}  // namespace pbf::verify_module
