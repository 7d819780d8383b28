// One frozen step: two solvers, one state, one update, all arrays that passes store. Each stage of
// B starts from A's results of the previous stage, so that errors do not propagate. For a pass with
// two stages, the propagated error is subtracted.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lib/verify/compare_parts.h"

namespace pbf::verify_module {
namespace {

/// Size of the difference of two arrays; NaN against a number is infinite.
struct Size {
  double worst = 0, rms = 0, scale = 0;
};

/// period: of the axes, h; 0: not periodic. A place at one face is also one at the other.
Size difference(const TraceArray& of_a, const TraceArray& of_b, const Double3& period) {
  const std::vector<double>&a = of_a.values, &b = of_b.values;
  const bool places = of_a.quantity == "position" && of_a.components == 3;
  Size s;
  for (std::size_t k = 0; k < a.size(); ++k) {
    double d = apart(a[k], b[k]);
    if (places && std::isfinite(d)) d = std::fabs(shortest(d, period[k % 3]));
    s.worst = std::max(s.worst, d);
    s.rms += d * d;
    if (std::isfinite(a[k])) s.scale = std::max(s.scale, std::fabs(a[k]));
  }
  s.rms = std::sqrt(s.rms / double(std::max<std::size_t>(a.size(), 1)));
  return s;
}

std::string name_of(const TraceArray& t) {
  return t.iteration ? fmt::format("{} {}: {}", t.stage, t.iteration, t.quantity)
                     : fmt::format("{}: {}", t.stage, t.quantity);
}

bool same_kind(const TraceArray& x, const TraceArray& y) {
  return x.stage == y.stage && x.iteration == y.iteration && x.quantity == y.quantity;
}

/// Number of terms in the sums of a stage, whose rounding the ensemble does not have.
double most_terms(const StepTrace& trace) {
  std::int64_t most = 0;
  for (std::size_t i = 0; i + 1 < trace.neighbor_begin.size(); ++i)
    most = std::max(most, trace.neighbor_begin[i + 1] - trace.neighbor_begin[i]);
  return 4 + double(most);
}
double terms_of(const TraceArray& t, const StepTrace& trace) {
  if (t.stage == "predict" || t.stage == "grid" || t.quantity == "position") return 4;
  return most_terms(trace);
}

/// Noise of every array, and of every reading after the step.
struct Noise {
  std::vector<double> arrays, readings;
};

/// Largest change over the ensemble, with each stage starting from the values of `a`.
Noise noise_floor(const Comparison& c, const SolverState& start, const StepTrace& a,
                  StepTrace& reference) {
  c.reference->set_state(start);
  reference = c.reference->inspection()->trace({0, 1, &a});
  const std::vector<Reading> readings = c.take(*c.reference, 1);
  Noise noise{std::vector<double>(reference.arrays.size(), 0), {}};
  const Double3 period = periods_in_h(*c.scene);
  for (std::size_t m = 0; m < c.members.size(); ++m) {
    c.members[m]->set_state(rounded(start, c.u, c.settings->seed + m));
    const StepTrace t = c.members[m]->inspection()->trace({c.u, c.settings->seed + m, &a});
    for (std::size_t k = 0; k < noise.arrays.size(); ++k)
      noise.arrays[k] =
          std::max(noise.arrays[k], difference(reference.arrays[k], t.arrays[k], period).worst);
    raise_to_distance(noise.readings, c.take(*c.members[m], 1), readings);
  }
  return noise;
}

/// A fused pass of B computes an array (the density) and uses it at once, so its second half does
/// not start from A's values, and the error propagates into its result (lambda). Subtracts from `b`
/// the effect that this error has in the reference. reference: its trace from the values of `a`.
void take_out_inherited(const Comparison& c, const SolverState& start, const StepTrace& a,
                        const StepTrace& reference, StepTrace& b) {
  StepTrace mixed = a;
  std::vector<std::size_t> heirs;
  for (std::size_t k = 0; k + 1 < std::min(a.arrays.size(), b.arrays.size()); ++k) {
    if (!b.arrays[k].used_at_once || !same_kind(a.arrays[k], b.arrays[k])) continue;
    mixed.arrays[k].values = b.arrays[k].values;
    heirs.push_back(k + 1);
  }
  if (heirs.empty()) return;
  c.reference->set_state(start);
  const StepTrace own = c.reference->inspection()->trace({0, 1, &mixed});
  for (const std::size_t k : heirs)
    for (std::size_t i = 0; i < b.arrays[k].values.size(); ++i)
      b.arrays[k].values[i] -= own.arrays[k].values[i] - reference.arrays[k].values[i];
}

/// Bins may differ if a coordinate is within rounding of a border; borders are half a cell apart
/// along every axis with bins, and at the ends of periodic axes. Returns the largest distance from
/// a border among particles whose bins differ.
Size bin_difference(const TraceArray& a, const TraceArray& b, const std::vector<double>& position,
                    double border, int dimensions, const Double3& period) {
  Size s;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    s.scale = std::max(s.scale, a.values[i]);
    if (a.values[i] == b.values[i]) continue;
    double nearest = border;
    for (std::size_t k = 3 * i; k < 3 * i + 3; k += dimensions == 2 ? 2 : 1)
      for (const double at : {position[k], shortest(position[k], period[k % 3])})
        nearest = std::min(nearest, std::fabs(std::remainder(at, border)));
    s.worst = std::max(s.worst, std::max(nearest, std::numeric_limits<double>::min()));
    s.rms += 1;
  }
  return s;
}

/// Sets of neighbors may differ in pairs whose distance is within rounding of h. Returns the
/// largest |distance - h| of a pair that only one side has; rms: the number of such pairs.
Size set_difference(const StepTrace& a, const StepTrace& b, const std::vector<double>& position,
                    const Double3& period) {
  Size s;
  s.scale = 1;
  std::vector<std::int32_t> only;
  for (std::size_t i = 0; i + 1 < a.neighbor_begin.size(); ++i) {
    only.clear();
    std::set_symmetric_difference(
        a.neighbors.begin() + a.neighbor_begin[i], a.neighbors.begin() + a.neighbor_begin[i + 1],
        b.neighbors.begin() + b.neighbor_begin[i], b.neighbors.begin() + b.neighbor_begin[i + 1],
        std::back_inserter(only));
    for (const std::int32_t j : only) {
      double d2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d =
            shortest(position[3 * i + k] - position[3 * std::size_t(j) + k], period[k]);
        d2 += d * d;
      }
      s.worst = std::max(
          s.worst, std::max(std::fabs(std::sqrt(d2) - 1), std::numeric_limits<double>::min()));
      s.rms += 1;
    }
  }
  return s;
}

const std::vector<double>& values_of(const StepTrace& t, const char* stage, const char* quantity) {
  for (const TraceArray& x : t.arrays)
    if (x.stage == stage && x.quantity == quantity) return x.values;
  return t.arrays.front().values;
}

}  // namespace

ComparePart compare_stages(const Comparison& c, const SolverState& start, CompareResult& result) {
  ComparePart part;
  part.name = "frozen step";
  c.a->set_state(start);
  c.b->set_state(start);
  const StepTrace a = c.a->inspection()->trace();
  StepTrace b = c.b->inspection()->trace({0, 1, &a});
  const std::vector<Reading> read_a = c.take(*c.a, 1), read_b = c.take(*c.b, 1);
  StepTrace reference;
  Noise noise;
  if (!c.same_bits) {
    noise = noise_floor(c, start, a, reference);
    take_out_inherited(c, start, a, reference, b);
  }
  part.tolerance_source =
      c.same_bits ? "0: both sides promise the same bits"
                  : fmt::format(
                        "{:g} x the largest change over {} references in double, whose constants, "
                        "start and every stored value are rounded at random to u = {:.3g}, + "
                        "(terms of the stage's sums) u max|value|{}; of loads and gauges besides "
                        "what their whole numbers leave open",
                        kNoiseFactor, c.members.size(), c.u,
                        c.sides > 1 ? "; twice that, since both sides round" : "");
  result.stage.clear();
  const auto add = [&](const std::string& what, const std::string& unit, const Size& s,
                       double tolerance, const std::string& stage) {
    CompareRow r{what, unit, s.worst, s.rms, 0, 0, tolerance, Verdict::same};
    r.relative = s.scale > 0 ? s.worst / s.scale : 0;
    r.ulps = s.scale > 0 ? s.worst / ulp(s.scale, c.u) : 0;
    if (!(s.worst <= tolerance)) {
      r.verdict = Verdict::differs;
      if (result.stage.empty()) result.stage = stage;
    }
    part.rows.push_back(r);
  };
  const std::vector<double>& position = values_of(a, "grid", "position");
  const Double3 period = periods_in_h(*c.scene);
  double position_tolerance = 0;
  bool lists_done = false;
  const auto add_lists = [&] {  // once, before what is summed over them
    if (!std::exchange(lists_done, true))
      add("neighbors: pairs", "h", set_difference(a, b, position, period),
          c.same_bits ? 0 : 4 * position_tolerance + 8 * c.u, "neighbors");
  };
  const std::size_t common = std::min(a.arrays.size(), b.arrays.size());
  std::size_t k = 0;
  for (; k < common && same_kind(a.arrays[k], b.arrays[k]); ++k) {
    const TraceArray &x = a.arrays[k], &y = b.arrays[k];
    if (x.stage != "predict" && x.stage != "grid") add_lists();
    if (x.quantity == "bin") {
      add(name_of(x), "h",
          bin_difference(x, y, position, c.plan->cell_edge / 2, c.scene->dimensions, period),
          position_tolerance, x.stage);
      continue;
    }
    const Size s = difference(x, y, period);
    const double tolerance =
        c.same_bits
            ? 0
            : c.sides * (kNoiseFactor * noise.arrays[k] + terms_of(x, reference) * c.u * s.scale);
    if (x.quantity == "position" && !lists_done) position_tolerance = tolerance;
    add(name_of(x), x.unit, s, tolerance, x.stage);
  }
  add_lists();
  if (k < a.arrays.size() || k < b.arrays.size()) {
    const bool only_b = k >= a.arrays.size() || (k < b.arrays.size() && b.arrays[k].iteration > 0);
    const TraceArray& t = only_b ? b.arrays[k] : a.arrays[k];
    CompareRow r{name_of(t),      "only on " + std::string(only_b ? "B" : "A"), 0, 0, 0, 0, 0,
                 Verdict::differs};
    part.rows.push_back(r);
    if (result.stage.empty()) result.stage = t.iteration > 0 ? "iterations" : t.stage;
  }
  // Loads and gauges are also summed from the values of A.
  for (std::size_t i = 0; i < read_a.size(); ++i) {
    const Reading& x = read_a[i];
    const Reading* y = find_reading(read_b, x.what);
    if (!y) continue;
    const double error = apart(x.value, y->value), scale = scale_of(x, *y);
    const double rounding =
        c.same_bits
            ? 0
            : c.sides * (kNoiseFactor * noise.readings[i] + most_terms(reference) * c.u * scale) +
                  x.grain;
    add(x.what, x.unit, {error, error, scale}, rounding, x.stage);
  }
  part.verdict = result.stage.empty() ? Verdict::same : Verdict::differs;
  part.finding = result.stage.empty()
                     ? "every stage of one update is within its tolerance"
                     : "every stage starts from the values of A, and the first one outside its "
                       "tolerance is `" +
                           result.stage + "`";
  return part;
}

}  // namespace pbf::verify_module
