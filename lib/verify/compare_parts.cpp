#include "lib/verify/compare_parts.h"

#include <algorithm>
#include <cmath>

#include "lib/program/dissipation.h"
#include "lib/program/free_bodies.h"

namespace pbf::verify_module {
namespace {

/// Reference for rounding: ReadingColumn::lever.
double scale_of(const ReadingColumn& c, const std::vector<ReadingColumn>& columns,
                const std::vector<double>& values) {
  double length = 0, peak = 0;
  for_each_number(columns, c.series, [&](const ReadingColumn& other, int, std::size_t k) {
    if (other.of != c.of) return;
    if (other.join == Join::peak) peak = values[k];
    if (std::string_view(other.unit) == c.unit) length = std::hypot(length, values[k]);
  });
  return c.lever > 0 ? c.lever * peak : length;
}

/// J. What a pass takes is a difference of kinetic energies, and has their rounding.
double kinetic_energy(Solver& solver, const Scene& scene, const Plan& plan) {
  double squares = 0;
  for (const double v : solver.state().velocity) squares += v * v;
  return 0.5 * plan.mass * scene.h() * scene.h() * squares;
}

/// Where the free bodies are; prescribed motions are the same by their scene.
void add_bodies(Solver& solver, const Scene& scene, const Plan& plan, std::vector<Reading>& out) {
  if (!has_free_bodies(scene)) return;
  const Snapshot now = solver.download({}, ScalarType::f64).get();
  const std::vector<double> values = pose_readings(scene, now.time, now.bodies);
  const std::vector<std::string> names = names_of_bodies(scene);
  for_each_number(plan.columns, Series::poses,
                  [&](const ReadingColumn& c, int component, std::size_t k) {
                    if (std::ranges::find(names, c.of) == names.end()) return;
                    out.push_back({"poses", "poses: " + c.of + " " + number_name(c, component),
                                   c.unit, values[k], scale_of(c, plan.columns, values), 0});
                  });
}

}  // namespace

std::vector<Reading> take_readings(Solver& solver, const Scene& scene, const Plan& plan,
                                   int updates) {
  std::vector<Reading> out;
  const double time = scene.time.step * updates;
  const double kinetic = dissipations(scene).empty() ? 0 : kinetic_energy(solver, scene, plan);
  for (const Series series : {Series::measures, Series::gauges}) {
    const std::vector<double> values = solver.readings(series, Interval::ends);
    for_each_number(
        plan.columns, series, [&](const ReadingColumn& c, int component, std::size_t k) {
          const std::string stage = series == Series::gauges ? "gauges" : std::string(c.kind) + "s";
          const std::string name = number_name(c, component);
          const bool taken = c.kind == std::string_view("dissipation");
          out.push_back({stage, stage + ": " + c.of + (name.empty() ? "" : " ") + name, c.unit,
                         values[k], taken ? kinetic : scale_of(c, plan.columns, values),
                         c.grain.value + c.grain.of_sum / time});
        });
  }
  add_bodies(solver, scene, plan, out);
  return out;
}

const Reading* find_reading(const std::vector<Reading>& readings, const std::string& what) {
  const auto r = std::ranges::find(readings, what, &Reading::what);
  return r == readings.end() ? nullptr : &*r;
}

double ulp(double value, double u) {
  if (!(value > 0) || !std::isfinite(value)) return 0;
  return 2 * u * std::exp2(std::floor(std::log2(value)));
}

double apart(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double d = std::fabs(a - b);
  return std::isnan(d) ? HUGE_VAL : d;
}

void raise_to_distance(std::vector<double>& to, const std::vector<Reading>& x,
                       const std::vector<Reading>& from) {
  to.resize(x.size(), 0);
  for (std::size_t k = 0; k < x.size(); ++k)
    to[k] = std::max(to[k], apart(x[k].value, from[k].value));
}

double scale_of(const Reading& a, const Reading& b) {
  double scale = 0;
  for (const double x : {std::fabs(a.value), std::fabs(b.value), a.scale, b.scale})
    if (std::isfinite(x)) scale = std::max(scale, x);
  return scale;
}

Distance distance(const std::vector<double>& x, const std::vector<double>& y, const Double3& period,
                  double (*difference)(double, double)) {
  Distance d;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    double r2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double e = shortest(difference(x[i + k], y[i + k]), period[k]);
      r2 += e * e;
    }
    d.worst = std::max(d.worst, std::sqrt(r2));
    d.rms += r2;
  }
  d.rms = std::sqrt(d.rms / double(std::max<std::size_t>(x.size() / 3, 1)));
  return d;
}

Double3 periods_in_h(const Scene& scene) {
  Double3 p = periods(scene);
  for (double& length : p) length /= scene.h();
  return p;
}

CommonRows common_rows(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
  CommonRows out;
  if (a == b) return out;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    if (a[i] == b[k])
      out.a.push_back(i++), out.b.push_back(k++);
    else
      ++(a[i] < b[k] ? i : k);
  }
  out.only_a = a.size() - out.a.size();
  out.only_b = b.size() - out.b.size();
  return out;
}

double share_of(double error, double tolerance) {
  return error == 0 ? 0 : tolerance > 0 ? error / tolerance : HUGE_VAL;
}

bool note(ComparePart& p, const std::string& what, const std::string& unit, double error,
          double scale, double tolerance, double u) {
  auto r = std::ranges::find(p.rows, what, &CompareRow::what);
  const bool fresh = r == p.rows.end();
  if (fresh) r = p.rows.insert(r, {what, unit, 0, 0, 0, 0, 0, Verdict::same});
  if (fresh || !(share_of(error, tolerance) <= share_of(r->error, r->tolerance))) {
    r->error = error;
    r->relative = scale > 0 ? error / scale : error;
    r->ulps = scale > 0 && u > 0 ? error / ulp(scale, u) : 0;
    r->tolerance = tolerance;
  }
  const bool within = error == 0 || error <= tolerance;
  if (!within) r->verdict = p.verdict = Verdict::differs;
  return within;
}

}  // namespace pbf::verify_module
