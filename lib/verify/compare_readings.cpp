#include "lib/verify/compare_readings.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

std::vector<Reading> take_readings(Solver& solver, const Scene& scene, const Plan& plan,
                                   int updates) {
  std::vector<Reading> out;
  const double time = scene.time.step * updates;
  for (const Series series : {Series::measures, Series::gauges}) {
    const std::vector<double> values = solver.readings(series, Interval::ends);
    for_each_number(
        plan.columns, series, [&](const ReadingColumn& c, int component, std::size_t k) {
          const std::string stage = series == Series::gauges ? "gauges" : std::string(c.kind) + "s";
          const std::string name = number_name(c, component);
          out.push_back({stage, stage + ": " + c.of + (name.empty() ? "" : " ") + name, c.unit,
                         values[k], scale_of(c, plan.columns, values),
                         c.grain.value + c.grain.of_sum / time});
        });
  }
  return out;
}

const Reading* find_reading(const std::vector<Reading>& readings, const std::string& what) {
  const auto r = std::find_if(readings.begin(), readings.end(),
                              [&](const Reading& one) { return one.what == what; });
  return r == readings.end() ? nullptr : &*r;
}

}  // namespace pbf::verify_module
