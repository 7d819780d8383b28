#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lib/campaign/stability.h"
#include "lib/run/emit.h"
#include "lib/run/prestabilize.h"

namespace pbf::inline campaign_module {

Course run_course(const Scene& scene, const std::string& dir,
                  const std::function<void(Solver&)>& done) {
  Course c;
  c.particles = count_particles(scene, dir);
  const Plan plan = make_plan(scene, c.particles);
  const auto solver = start_solver(scene, plan, emit_particles(scene, dir));
  std::vector<std::pair<double, double>> compression;
  Watch watch(scene, plan, *solver, [&](const Diagnostics& m, double) {
    if (compression.empty()) {
      c.first = m;
      c.scale = energy_scale(m, scene, plan.mass, c.particles);
      c.released = released_energy(m, scene, plan) / (c.scale > 0 ? c.scale : 1);
    }
    const double rise = total_energy(m) - total_energy(c.first);
    // Without gravity and at rest there is no scale: any rise counts in full.
    c.energy_rise = std::max(c.energy_rise, c.scale > 0 ? rise / c.scale : rise);
    c.speed_max = std::max(c.speed_max, m.speed_max);
    compression.push_back({m.compression_mean, m.compression_max});
  });
  Session(*solver, {&watch, &watch.choosing()}).run(make_schedule(scene).updates);
  c.last = watch.last();
  c.updates = c.last.update;
  if (watch.event()) c.event = *watch.event();
  c.steps = watch.steps(c.updates);
  const std::size_t settled = std::max<std::size_t>(1, compression.size() / 4);
  for (std::size_t k = compression.size() - settled; k < compression.size(); ++k) {
    c.compression_mean += compression[k].first / double(settled);
    c.compression_max = std::max(c.compression_max, compression[k].second);
  }
  if (c.event) c.guard_text = watch.guard()->text(*c.event);
  if (done) done(*solver);
  return c;
}

double nearest_distance(const std::vector<double>& x) {
  const std::size_t n = x.size() / 3;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return x[3 * a] < x[3 * b]; });
  double best = std::numeric_limits<double>::infinity();
  // Only those within the best distance along x can be nearer.
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const double *a = &x[3 * order[i]], *b = &x[3 * order[j]];
      if (b[0] - a[0] >= best) break;
      best = std::min(best, std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
    }
  return best;
}

}  // namespace pbf::inline campaign_module
