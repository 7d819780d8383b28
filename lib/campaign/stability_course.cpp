#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lib/campaign/stability.h"

namespace pbf::campaign_module {
namespace {

/// Largest sum since the start of any gauge: of flow, kg.
double most_through(const std::vector<ReadingColumn>& columns, Solver& solver) {
  double most = 0;
  const std::vector<double> readings = solver.readings(Series::gauges, Interval::goes_on);
  for_each_number(columns, Series::gauges, [&](const ReadingColumn& c, int, std::size_t k) {
    if (c.join == Join::total) most = std::max(most, std::fabs(readings[k]));
  });
  return most;
}

}  // namespace

std::optional<Course> run_course(Start start, const std::function<bool()>& stop,
                                 const std::function<void(Solver&)>& done) {
  Course c;
  const Scene& scene = start.scene();
  const Plan& plan = start.plan;
  c.particles = plan.particles;
  const auto solver = solver_of(start);
  std::vector<std::pair<double, double>> compression;
  double loads_since = 0;  // s
  Monitor monitor(scene, plan, *solver, [&](const Diagnostics& m, double) {
    if (compression.empty()) {
      c.first = m;
      c.scale = energy_scale(m, scene, plan);
      c.released = released_energy(m, scene, plan) / (c.scale > 0 ? c.scale : 1);
    }
    const double rise = total_energy(m) - total_energy(c.first);
    // Without gravity and at rest there is no scale; the rise itself is used.
    c.energy_rise = std::max(c.energy_rise, c.scale > 0 ? rise / c.scale : rise);
    c.speed_max = std::max(c.speed_max, m.speed_max);
    c.penetration = std::max(c.penetration, m.penetration);
    if (!scene.gauges.empty()) c.through = std::max(c.through, most_through(plan.columns, *solver));
    for_each_number(plan.columns, Series::measures,
                    [&](const ReadingColumn& load, int a, std::size_t k) {
                      if (load.name == std::string("force"))
                        c.impulse[a] += m.readings[k] * (m.time - loads_since);
                    });
    loads_since = m.time;
    compression.push_back({m.compression_mean, m.compression_max});
  });
  bool stopped = false;
  Callback stopping([](std::int64_t) { return kAlways; },
                    [&](Session&) {
                      stopped = stop && stop();
                      return stopped ? Next::stop : Next::go_on;
                    });
  // Calls of at most a second, so that a stop does not wait longer.
  Session(*solver, {&monitor, &monitor.choosing(), &stopping}, 1).run(make_schedule(scene).updates);
  if (stopped) return std::nullopt;
  c.last = monitor.last();
  c.updates = c.last.update;
  if (monitor.event()) c.event = *monitor.event();
  c.steps = monitor.steps(c.updates);
  const std::size_t settled = std::max<std::size_t>(1, compression.size() / 4);
  for (std::size_t k = compression.size() - settled; k < compression.size(); ++k) {
    c.compression_mean += compression[k].first / double(settled);
    c.compression_max = std::max(c.compression_max, compression[k].second);
  }
  if (c.event) c.guard_text = monitor.guard()->text(*c.event);
  if (done) done(*solver);
  return c;
}

double nearest_distance(const std::vector<double>& x) {
  const std::size_t n = x.size() / 3;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return x[3 * i]; });
  double best = std::numeric_limits<double>::infinity();
  // Sorted by x, only particles within the best distance along x can be closer.
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const double *a = &x[3 * order[i]], *b = &x[3 * order[j]];
      if (b[0] - a[0] >= best) break;
      best = std::min(best, std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
    }
  return best;
}

}  // namespace pbf::campaign_module
