#include "lib/verify/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace pbf::verify_module {
namespace {

/// Sorts NaN last, so that the order is total.
bool before(double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; }

/// `effect`: number of particles that move together.
Statistic mean(const std::string& name, const std::string& unit, const std::vector<double>& v,
               double effect = 1) {
  double sum = 0, squares = 0;
  for (const double x : v) sum += x;
  const double n = double(v.size()), m = sum / n;
  for (const double x : v) squares += (x - m) * (x - m);
  return {name, unit, m, kSigmas * std::sqrt(effect * squares / n / n), 0};
}

/// `v` is sorted. The value at index ceil(p n), counted from 1.
double at(const std::vector<double>& v, double p) {
  const double k = std::ceil(std::clamp(p, 0.0, 1.0) * double(v.size()));
  return v[std::size_t(std::max(k, 1.0)) - 1];
}

Statistic quantile(const std::string& name, const std::string& unit, const std::vector<double>& v,
                   double p, double effect = 1) {
  const double d = kSigmas * std::sqrt(effect * p * (1 - p) / double(v.size())), q = at(v, p);
  const double below = q - at(v, p - d), above = p + d > 1 ? 2 * below : at(v, p + d) - q;
  return {name, unit, q, std::max(above, below), 0};
}

}  // namespace

Clusters::Clusters(const std::vector<double>& position, double edge) {
  for (double e = edge; e > 0 && e <= 4 * edge; e *= 2) {
    std::map<std::array<double, 3>, std::size_t> number;
    Grid grid;
    grid.cell.resize(position.size() / 3);
    for (std::size_t i = 0; i < grid.cell.size(); ++i) {
      std::array<double, 3> at{};
      for (std::size_t k = 0; k < 3; ++k) {
        at[k] = std::floor(position[3 * i + k] / e);
        if (std::isnan(at[k])) at[k] = HUGE_VAL;  // NaN has no order
      }
      grid.cell[i] = number.try_emplace(at, number.size()).first->second;
    }
    grid.cells = number.size();
    grids_.push_back(std::move(grid));
  }
}
double Clusters::design_effect(const std::vector<double>& values) const {
  double sum = 0, alone = 0, most = 1;
  for (const double v : values) sum += v;
  const double mean = sum / double(values.size());
  for (const double v : values) alone += (v - mean) * (v - mean);
  for (const Grid& grid : grids_) {
    std::vector<double> of_cell(grid.cells, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) of_cell[grid.cell[i]] += values[i] - mean;
    double together = 0;
    for (const double s : of_cell) together += s * s;
    const double effect = together / alone;
    if (std::isfinite(effect)) most = std::max(most, effect);
  }
  return most;
}
double Clusters::mean_size() const {
  if (grids_.empty() || grids_[0].cells == 0) return 1;
  return double(grids_[0].cell.size()) / double(grids_[0].cells);
}
double Clusters::design_effect_of_shares(const std::vector<double>& values,
                                         const std::vector<double>& sorted) const {
  double largest = 1;
  std::vector<double> below(values.size());
  for (const double p : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    const double q = sorted[std::size_t(p * double(sorted.size()))];
    for (std::size_t i = 0; i < values.size(); ++i) below[i] = values[i] <= q ? 1 : 0;
    largest = std::max(largest, design_effect(below));
  }
  return largest;
}

std::vector<double> numbers_of(const FieldArray& f) {
  if (f.type == ScalarType::f64) return {f.as<double>().begin(), f.as<double>().end()};
  return {f.as<float>().begin(), f.as<float>().end()};
}

FrameStatistics frame_statistics(const Snapshot& s, const Double3& origin, const Double3& gravity,
                                 double rest_density, const Resolution& resolution) {
  FrameStatistics out;
  if (s.count == 0) return out;
  const std::vector<double> x = numbers_of(s.fields[0]);
  const auto column = [&](const std::function<double(std::size_t)>& f) {
    std::vector<double> v(s.count);
    for (std::size_t i = 0; i < s.count; ++i) v[i] = f(i);
    return v;
  };
  const auto distribute = [&](const char* name, const char* unit, std::vector<double> v,
                              double resolution_of_it, const Clusters* together = nullptr) {
    std::vector<double> sorted = v;
    std::ranges::sort(sorted, before);
    const double effect = together ? together->design_effect_of_shares(v, sorted) : 1;
    out.distributions.push_back(
        {name, unit, std::move(sorted), resolution_of_it, double(v.size()) / effect});
    return &out.distributions.back();
  };
  // Means of positions need no correction: particles are spread more evenly than a random sample.
  // The particles at a front move together.
  const Clusters cells(x, resolution.cluster), alone(x, 0);
  const Clusters& together = resolution.mixed ? cells : alone;
  const auto add = [&](Statistic number, double resolution_of_it) {
    number.resolution = resolution_of_it;
    out.numbers.push_back(std::move(number));
  };
  const char* axes[] = {"x", "y", "z"};
  const double g = std::fabs(gravity[0]) + std::fabs(gravity[1]) + std::fabs(gravity[2]);
  add(mean("potential energy", "J/kg", column([&](std::size_t i) {
             double e = 0;
             for (std::size_t k = 0; k < 3; ++k) e -= gravity[k] * (x[3 * i + k] - origin[k]);
             return e;
           })),
      g * resolution.length);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis = axes[k];
    auto v = column([&](std::size_t i) { return x[3 * i + k] - origin[k]; });
    add(mean("centre of mass " + axis, "m", v), resolution.length);
    add(quantile("front " + axis + " (99.9 %)", "m",
                 distribute(axes[k], "m", v, resolution.length)->values, 0.999, cells.mean_size()),
        resolution.length + resolution.front);
  }
  if (const FieldArray* f = s.find("velocity")) {
    const std::vector<double> v = numbers_of(*f);
    const auto squared = [&](std::size_t i) {
      return v[3 * i] * v[3 * i] + v[3 * i + 1] * v[3 * i + 1] + v[3 * i + 2] * v[3 * i + 2];
    };
    const double speed =
        mean("", "", column([&](std::size_t i) { return std::sqrt(squared(i)); })).value;
    const auto energy = column([&](std::size_t i) { return 0.5 * squared(i); });
    add(mean("kinetic energy", "J/kg", energy, together.design_effect(energy)),
        3 * resolution.speed * (std::isfinite(speed) ? speed + resolution.speed : 0));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = column([&](std::size_t i) { return v[3 * i + k]; });
      add(mean(std::string("momentum ") + axes[k], "m/s", component,
               together.design_effect(component)),
          resolution.speed);
      out.numbers.back().scale = speed;
    }
    distribute("speed", "m/s", column([&](std::size_t i) { return std::sqrt(squared(i)); }),
               2 * resolution.speed, &together);  // sqrt(3) components
  }
  if (const FieldArray* f = s.find("density")) {
    const std::vector<double> rho = numbers_of(*f);
    const auto volumes = column([&](std::size_t i) { return rest_density / rho[i]; });
    const Statistic volume =
        mean("volume", "rest volumes", volumes, together.design_effect(volumes));
    add(volume, resolution.density * std::fabs(volume.value));
    const auto* error = distribute("density error", "1",
                                   column([&](std::size_t i) { return rho[i] / rest_density - 1; }),
                                   resolution.density, &together);
    const double effect = double(error->values.size()) / error->samples;
    for (const auto& [name, p] : {std::pair<const char*, double>{"density error 50 %", 0.5},
                                  {"density error 90 %", 0.9},
                                  {"density error 99 %", 0.99}})
      add(quantile(name, "1", error->values, p, effect), resolution.density);
  }
  return out;
}

namespace {

/// Largest excess of the fraction of `a` up to x over the fraction of `b` up to x + rounding. It is
/// enough to test the values x in `a`.
double excess(const std::vector<double>& a, const std::vector<double>& b, double rounding) {
  double largest = 0;
  for (std::size_t i = 0, k = 0; i < a.size();) {
    const double x = a[i];
    while (i < a.size() && !before(x, a[i])) ++i;
    while (k < b.size() && !before(x + rounding, b[k])) ++k;
    largest = std::max(largest, double(i) / double(a.size()) - double(k) / double(b.size()));
  }
  return largest;
}

}  // namespace

double ks_distance(const std::vector<double>& a, const std::vector<double>& b, double rounding) {
  if (a.empty() || b.empty()) return 0;
  return std::max(excess(a, b, rounding), excess(b, a, rounding));
}

double ks_critical(double alpha, double n, double m) {
  return std::sqrt(-0.5 * std::log(alpha / 2) * (n + m) / (n * m));
}

double e_folding(const std::vector<double>& x, const std::vector<double>& y, double upper) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, first = HUGE_VAL, last = -HUGE_VAL;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(y[k] > 0 && y[k] < upper)) continue;
    const double l = std::log(y[k]);
    first = std::min(first, x[k]), last = std::max(last, x[k]);
    n += 1, sx += x[k], sy += l, sxx += x[k] * x[k], sxy += x[k] * l;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 3 || !(spread > 0)) return 0;
  const double slope = (n * sxy - sx * sy) / spread;
  return slope * (last - first) > 0.01 ? 1 / slope : 0;
}

}  // namespace pbf::verify_module
