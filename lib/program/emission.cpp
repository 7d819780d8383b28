#include "lib/program/emission.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/base/error.h"
#include "lib/program/motion_table.h"
#include "lib/program/schedule.h"

namespace pbf::program_module {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// How many layers of an emitter have begun when these have made `way` (m). begun(layer) decides,
/// so that all agree; the way tells where to begin.
template <class Begun>
std::int64_t layers_begun(const EmissionPlan& plan, double way, const Begun& begun) {
  std::int64_t n = plan.layers + std::int64_t(std::floor(way / plan.spacing + 0.5));
  while (n > plan.layers && !begun(n - 1)) --n;
  while (begun(n)) ++n;
  return n;
}

}  // namespace

SpeedCurve::SpeedCurve(const Scene& s, const Emitter& e) {
  const double end = e.end.value_or(std::max(s.time.end, e.start));
  const auto add = [&](double t) {
    const double v = e.speed ? *e.speed : e.table.time.empty() ? 0 : straight(e.table, 0, t);
    const double more = time_.empty() ? 0 : 0.5 * (speed_.back() + v) * (t - time_.back());
    way_.push_back(way_.empty() ? 0 : way_.back() + more);
    time_.push_back(t);
    speed_.push_back(v);
  };
  if (!(end > e.start) || !std::isfinite(e.start)) return;
  add(e.start);
  for (const double t : e.table.time)
    if (t > e.start && t < end) add(t);
  add(end);
}

double SpeedCurve::speed(double t) const {
  if (time_.empty() || t < time_.front() || t > time_.back()) return 0;
  const auto k =
      std::min(std::size_t(std::upper_bound(time_.begin(), time_.end(), t) - time_.begin()),
               time_.size() - 1) -
      1;
  const double u = (t - time_[k]) / (time_[k + 1] - time_[k]);
  return (1 - u) * speed_[k] + u * speed_[k + 1];
}

double SpeedCurve::way(double t) const {
  if (time_.empty() || t <= time_.front()) return 0;
  if (t >= time_.back()) return way_.back();
  const auto k = std::size_t(std::upper_bound(time_.begin(), time_.end(), t) - time_.begin()) - 1;
  return way_[k] + 0.5 * (speed_[k] + speed(t)) * (t - time_[k]);
}

double SpeedCurve::time_of(double way) const {
  if (time_.empty() || way > way_.back()) return kNever;
  const auto next = std::size_t(std::lower_bound(way_.begin(), way_.end(), way) - way_.begin());
  if (next == 0) return time_.front();
  const std::size_t k = next - 1;
  const double width = time_[next] - time_[k], slope = (speed_[next] - speed_[k]) / width,
               left = way - way_[k];
  // The root of speed u + slope u^2/2 = left, without cancellation.
  const double root =
      std::sqrt(std::max(speed_[k] * speed_[k] + 2 * slope * left, 0.0)) + speed_[k];
  return time_[k] + (root > 0 ? std::min(2 * left / root, width) : width);
}

double EmissionPlan::birth(std::size_t e, std::int64_t layer) const {
  if (layer < layers) return -kNever;
  return nozzles[e].curve.time_of((double(layer - layers) + 0.5) * spacing);
}

std::int64_t EmissionPlan::born(std::size_t e, double t) const {
  return layers_begun(*this, nozzles[e].curve.way(t),
                      [&](std::int64_t k) { return birth(e, k) <= t + slack; });
}

std::int64_t EmissionPlan::particles(double t) const {
  std::int64_t sum = first_id;
  for (std::size_t e = 0; e < nozzles.size(); ++e) sum += nozzles[e].columns * born(e, t);
  return sum;
}

std::int64_t EmissionPlan::at_start() const {
  std::int64_t sum = first_id;
  for (const PlannedNozzle& n : nozzles) sum += n.columns * layers;
  return sum;
}

std::int64_t EmissionPlan::id(std::size_t e, std::int64_t layer) const {
  const double time = birth(e, layer);
  std::int64_t before = first_id + nozzles[e].columns * layer;
  for (std::size_t o = 0; o < nozzles.size(); ++o) {
    if (o == e) continue;
    // Layers of o that begin earlier, or at the same time if o stands before e.
    const auto earlier = [&](std::int64_t k) {
      const double t = birth(o, k);
      return t < time || (t == time && o < e);
    };
    const std::int64_t of_start = o < e ? layers : 0;
    const std::int64_t n =
        std::isinf(time) ? of_start : layers_begun(*this, nozzles[o].curve.way(time), earlier);
    before += n * nozzles[o].columns;
  }
  return before;
}

std::pair<std::size_t, std::int64_t> EmissionPlan::of_id(std::int64_t wanted) const {
  for (std::size_t e = 0; e < nozzles.size(); ++e) {
    std::int64_t low = 0, high = 1;  // ids grow with layers
    while (birth(e, high) < kNever && id(e, high) <= wanted) high *= 2;
    while (high - low > 1) {
      const std::int64_t middle = (low + high) / 2;
      const bool later = !(birth(e, middle) < kNever) || id(e, middle) > wanted;
      (later ? high : low) = middle;
    }
    if (const std::int64_t first = id(e, low);
        wanted >= first && wanted < first + nozzles[e].columns)
      return {e, low};
  }
  return {0, 0};
}

EmissionPlan plan_emission(const Scene& s, std::int64_t bodies) {
  EmissionPlan plan;
  plan.spacing = s.fluid.spacing;
  plan.slack = 1e-9 * s.time.step;
  plan.layers = held_layers(s);
  plan.first_id = bodies;
  double fastest = 0;
  for (const Emitter& e : s.emitters) {
    PlannedNozzle n{nozzle_place(s, e), SpeedCurve(s, e)};
    n.columns = std::int64_t(n.place.column.size());
    n.area = double(n.columns) * s.cell_volume() / s.fluid.spacing;
    fastest = std::max(fastest, fastest_of(e));
    plan.nozzles.push_back(std::move(n));
  }
  plan.most_born = int(std::ceil(fastest * s.time.step / s.fluid.spacing)) + 1;
  return plan;
}

std::int64_t particles_in_pipes(const Scene& s) {
  return s.emitters.empty() ? 0 : plan_emission(s, 0).at_start();
}

EmitterStep emitter_at(const EmissionPlan& plan, std::size_t e, double time) {
  EmitterStep now;
  const std::int64_t first = plan.released(e, time);
  now.held = plan.layers;
  now.front = plan.nozzles[e].curve.way(time) - (double(first) + 0.5) * plan.spacing;
  now.speed = plan.nozzles[e].curve.speed(time);
  for (int m = 0; m < now.held; ++m) now.id[m] = plan.id(e, first + m);
  return now;
}

EmitterStep emitter_step(const EmissionPlan& plan, std::size_t e, std::int64_t substep, double dt,
                         int substeps, int lists) {
  EmitterStep now;
  const double begin = double(substep) * dt, end = double(substep + 1) * dt;
  // Layers begin where lists are made, for all substeps on these.
  const std::int64_t in_update = substep % substeps;
  std::int64_t from = 0, to = substeps;
  for (int r = 0; r < lists; ++r) {
    from = std::int64_t(substeps) * r / lists, to = std::int64_t(substeps) * (r + 1) / lists;
    if (in_update < to) break;
  }
  const std::int64_t born = plan.born(e, double(substep - in_update + to) * dt),
                     first = plan.released(e, begin);
  now.released = int(plan.released(e, end) - first);
  now.held = int(born - first);
  now.born = in_update == from ? int(born - plan.born(e, begin)) : 0;
  if (now.held > kPipeLayers || now.born > plan.most_born)
    throw Error(ExitCode::internal, "too many layers in a pipe");
  const SpeedCurve& curve = plan.nozzles[e].curve;
  now.front = curve.way(end) - (double(first) + 0.5) * plan.spacing;
  now.speed = (curve.way(end) - curve.way(begin)) / dt;
  for (int m = 0; m < now.held; ++m) now.id[m] = plan.id(e, first + m);
  return now;
}

std::int64_t most_particles_of(const Scene& s, const EmissionPlan& plan) {
  return plan.particles(double(make_schedule(s).updates) * s.time.step);
}

std::string no_row_text(const Scene& s, const EmissionPlan& plan, std::int64_t id) {
  const auto [e, layer] = plan.of_id(id);
  return fmt::format("at t = {:.6g} s emitters[{}] ({}) had no room for a layer of {} particles; ",
                     plan.birth(e, layer), e, s.emitters[e].name, plan.nozzles[e].columns);
}

}  // namespace pbf::program_module
