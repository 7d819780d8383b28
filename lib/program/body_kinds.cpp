#include "lib/program/body_kinds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/program/body_mass.h"
#include "lib/program/free_bodies.h"
#include "lib/program/obstacle_motion.h"
#include "lib/scene/vector3.h"

namespace pbf::program_module {
namespace {

/// m: largest distance of a point of its section from Obstacle::middle(), in two dimensions.
double flat_size(const Scene& s, const Obstacle& o) {
  double most = 0;
  for (const ContactPoint& p : contact_points(s, o)) most = std::max(most, length(p.at) + p.radius);
  return most;
}

}  // namespace

std::vector<BodyKind> body_kinds(const Scene& s, const Plan& plan) {
  std::vector<BodyKind> all;
  const double h = s.h();
  // A particle of two dimensions has the mass of the slab between the walls.
  const double unit = plan.mass / (s.dimensions == 2 ? s.domain.max[1] - s.domain.min[1] : 1);
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const Obstacle& o = s.obstacles[k];
    if (!o.free) continue;
    const BodyMass mass = body_mass(s, o);
    const Solid<double>& solid = plan.solids[k];
    BodyKind b;
    b.solid = int(k);
    b.mass = mass.mass / unit;
    const Vec3<double> middle = (1 / h) * along_internal(plan.axes, o.middle() - mass.center);
    put(b.middle, s.dimensions == 2 ? Vec3<double>{middle.x, 0, middle.z} : middle);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = std::size_t(plan.axes.of[i]);
      for (std::size_t j = 0; j < 3; ++j) {
        b.inertia[i][j] = mass.inertia[row][std::size_t(plan.axes.of[j])] / (unit * h * h);
        b.axes[i][j] = solid.turn[i][j];
      }
      b.held[i] = o.free->locks(kLockNames[row]);
      b.kept[i] = o.free->locks(kLockNames[3 + row]);
    }
    if (s.dimensions == 2) b.held[1] = b.kept[0] = b.kept[2] = true;
    b.radius = (s.dimensions == 2 ? flat_size(s, o) / h : size_of(solid)) +
               std::sqrt(dot(vec(b.middle), vec(b.middle)));
    all.push_back(b);
  }
  return all;
}

std::vector<BodyState> first_bodies(const Scene& s, const Plan& plan,
                                    const std::vector<BodyKind>& kinds) {
  std::vector<BodyState> all;
  const double h = s.h();
  for (const BodyKind& b : kinds) {
    const Obstacle& o = s.obstacles[std::size_t(b.solid)];
    BodyState now;
    put(now.at.center, plan.solids[std::size_t(b.solid)].center - vec(b.middle));
    put(now.velocity, without(b.held, (1 / h) * along_internal(plan.axes, o.free->velocity)));
    const Vec3<double> rate = (plan.axes.handedness() * std::numbers::pi / 180) *
                              along_internal(plan.axes, o.free->angular);
    put(now.spin, without(b.kept, times(b.inertia, without(b.kept, rate))));
    now.energy = energy_of(b, now, (1 / h) * along_internal(plan.axes, s.gravity));
    all.push_back(now);
  }
  return all;
}

BodyMotion motion_of(const BodyKind& b, const BodyState& now, const Scene& s, const Axes& axes) {
  const double h = s.h();
  const BodyTurn turn(now.at.turn);
  BodyMotion out;
  out.middle = s.origin() + h * along_scene(axes, vec(now.at.center) + turn.of(vec(b.middle)));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out.turn[std::size_t(axes.of[i])][std::size_t(axes.of[j])] = turn.row[i][j];
  out.velocity = h * along_scene(axes, vec(now.velocity));
  out.spin = axes.handedness() * along_scene(axes, rate_by(inverse_of(b, turn), vec(now.spin)));
  return out;
}

Spots contact_spots(const Scene& s, const Plan& plan, std::size_t more) {
  Spots out;
  const double h = s.h();
  int body = 0;
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const Obstacle& o = s.obstacles[k];
    const Solid<double>& solid = plan.solids[k];
    SolidSpots& row = out.of_solid.emplace_back();
    row.first = int(out.all.size());
    for (const ContactPoint& p : contact_points(s, o)) {
      ContactSpot& spot = out.all.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) spot.at[i] = p.at[i] / h;
      spot.radius = p.radius / h;
    }
    row.count = int(out.all.size()) - row.first;
    if (o.free) row.body = body++;
    row.radius = is_endless(solid) ? kEndless : size_of(solid);
  }
  for (std::size_t k = 0; k < more; ++k)
    out.of_solid.push_back({int(out.all.size()), 0, -1, kEndless});
  return out;
}

std::int64_t contact_spots_in(const Scene& s) {
  std::int64_t all = 0;
  for (const Obstacle& o : s.obstacles) all += std::int64_t(contact_points(s, o).size());
  return all;
}

}  // namespace pbf::program_module
