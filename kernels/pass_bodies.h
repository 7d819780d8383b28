// The motion of free bodies within an update.
#pragma once

#include "kernels/boundary/body_contact.h"
#include "kernels/boundary/solid_boundary.h"

namespace pbf::PBF_VARIANT {

/// h: how far a body may be from where it was predicted to be at the start of the substep, beside
/// the way that was predicted: it may stop, and a little more. What it is owed beyond this, it gets
/// in the next one.
constexpr double kFollowRoom = 0.1;

/// What the passes of bodies share.
template <class Real>
struct BodyRows {
  const BodyKind* kind;
  BodyState* state;  ///< in/out
  BodyStep* step;    ///< in/out
  int bodies;
  double dt;                           ///< s, of a substep
  double unit, moment_unit;            ///< h/s and h of LoadSums
  const LoadSums* sums;                ///< as in LoadBook
  const LoadSums* clamps;              ///< the same; may be null
  SharerSums* sharers;                 ///< in/out: SolidScene::sharers
  PosedSolid<Real>* placed = nullptr;  ///< out: of the bodies
  Solid<Real>* before = nullptr;       ///< the same
  SolidVelocity* velocity = nullptr;   ///< the same
  BodyShare* share = nullptr;          ///< the same

  /// Adds what the body has been given since the last call to what it is owed. Returns the part of
  /// it that it may take: if more particles have pushed it than it was split among, less than all.
  PBF_HD double collect(int b) const {
    BodyState& s = state[b];
    BodyStep& now = step[b];
    const int wall = load_row_of_solid(kind[b].solid);
    LoadSums all = all_parts(sums, wall);
    if (clamps) all = all_parts(clamps, wall, all);
    double way[3], moment[3];
    for (int k = 0; k < 3; ++k) {
      way[k] = unit * double(all.way[k] - now.seen.way[k]);
      moment[k] = unit * moment_unit * double(all.moment[k] - now.seen.moment[k]);
    }
    now.seen = all;
    put(s.owed, vec(s.owed) + vec(way));
    put(s.owed_spin, vec(s.owed_spin) + (vec(moment) - cross(vec(s.at.center), vec(way))));
    return take_sharers(b);
  }
  /// Takes the sharers that have been counted; the part of what they gave that the body may take.
  PBF_HD double take_sharers(int b) const {
    const int k = kind[b].solid;
    Sharers now, &among = state[b].among;
    for (int part = 0; part < kLoadParts; ++part) {
      SharerSums& one = sharers[k * kLoadParts + part];
      now.pushed += double(one.pushed), now.stopped += double(one.stopped);
      one = {};
    }
    const double pushed = follow_number(among.pushed, now.pushed),
                 stopped = follow_number(among.stopped, now.stopped);
    share[k].among = {max2(among.pushed, 1.0), max2(among.stopped, 1.0)};
    return min2(pushed, stopped);
  }
  /// Of sharers, who have become `now`; the part of what they gave that the body may take.
  PBF_HD static double follow_number(double& among, double now) {
    const double before = max2(among, 1.0);
    among = max2(now, kSharersKept * among);
    return before / max2(before, now);
  }
  /// Moves body b from the start of the substep to its end.
  PBF_HD void move(int b) const {
    BodyState& s = state[b];
    const Vec3<double> v = vec(s.velocity), rate = rate_by(step[b].inverse, vec(s.spin));
    s.at = moved(step[b].start, v, rate, dt);
    const BodyFrame<Real> frame = frame_at<Real>(kind[b], s.at);
    const int k = kind[b].solid;
    static_cast<BodyFrame<Real>&>(placed[k].solid) = frame;
    SolidVelocity& u = velocity[k];
    share[k].free = true;
    put(share[k].center, vec(s.at.center));
    share[k].inverse = step[b].inverse;
    u.moves = u.free = true;
    put(u.linear, v - cross(rate, vec(s.at.center)));
    put(u.angular, rate);
    put(u.middle, {double(frame.center.x), double(frame.center.y), double(frame.center.z)});
  }
};

/// After a state was set: puts the bodies to where they are.
template <class Real>
struct PlaceBodiesPass {
  const BodyKind* kind;
  const BodyState* state;
  PosedSolid<Real>* placed;  ///< out
  Solid<Real>* before;       ///< out
  PBF_HD void operator()(int b) const {
    const int k = kind[b].solid;
    static_cast<BodyFrame<Real>&>(placed[k].solid) = frame_at<Real>(kind[b], state[b].at);
    before[k] = placed[k].solid;
  }
};

/// At the start of a substep: bodies take what they are owed, and gravity.
template <class Real>
struct StartBodiesPass {
  BodyRows<Real> rows;
  ContactScene<Real> contacts;
  Vec3<double> gravity;  ///< h/s^2

  PBF_HD void operator()(int b) const {
    BodyState& s = rows.state[b];
    BodyStep& step = rows.step[b];
    const BodyKind& kind = rows.kind[b];
    const double part = rows.collect(b);
    step.start = s.at;
    step.inverse = inverse_of(kind, BodyTurn(s.at.turn));
    follow(kind, step.inverse, s, part);
    put(s.velocity, without(kind.held, vec(s.velocity) + rows.dt * gravity));
    put(s.spin, without(kind.kept, vec(s.spin)));
    contacts.find(b, step, rate_by(step.inverse, vec(s.spin)), rows.dt, kFollowRoom);
  }
};

/// Behind it: contacts, and where the bodies will be at the end of the substep.
template <class Real>
struct PredictBodiesPass {
  BodyRows<Real> rows;
  Real range;   ///< h, of the walls' density, and the room of near rows
  double pull;  ///< h/s^2, size of gravity

  PBF_HD void operator()(int) const {
    solve_contacts(rows.kind, rows.state, rows.step, rows.bodies, rows.dt);
    for (int b = 0; b < rows.bodies; ++b) {
      const BodyState& s = rows.state[b];
      BodyStep& step = rows.step[b];
      const int k = rows.kind[b].solid;
      const Vec3<double> v = vec(s.velocity), rate = rate_by(step.inverse, vec(s.spin));
      put(step.velocity, v), put(step.rate, rate);
      PosedSolid<Real>& placed = rows.placed[k];
      rows.before[k] = placed.solid;
      const Bounds<Real> from = bounds_at(placed.solid);
      rows.move(b);
      const Bounds<Real> to = bounds_at(placed.solid);
      // As far as it may go until the lists of the next step are made.
      const double dt = rows.dt, size = rows.kind[b].radius + double(range);
      const double way = dt * (square_root(dot(v, v)) + size * square_root(dot(rate, rate)));
      const Real more = Real(way + dt * dt * pull + 2 * kFollowRoom);
      placed.reach = range + more;
      const Vec3<Real> wide{placed.reach, placed.reach, placed.reach};
      placed.bounds = {Vec3<Real>{min2(from.low.x, to.low.x), min2(from.low.y, to.low.y),
                                  min2(from.low.z, to.low.z)} -
                           wide,
                       Vec3<Real>{max2(from.high.x, to.high.x), max2(from.high.y, to.high.y),
                                  max2(from.high.z, to.high.z)} +
                           wide};
    }
  }

 private:
  PBF_HD static Bounds<Real> bounds_at(const Solid<Real>& o) {
    const auto reach = [&](Real x, Real y, Real z) {
      return reach_along(o, Vec3<Real>{x, y, z}, false);
    };
    const Real one(1), no(0);
    const Vec3<Real> high{reach(one, no, no), reach(no, one, no), reach(no, no, one)},
        low{reach(-one, no, no), reach(no, -one, no), reach(no, no, -one)};
    return {o.center - low, o.center + high};
  }
};

/// Over the rows near solids, when bodies are where they will be at the end of the substep: counts
/// those that may push them, before any does. Otherwise the first ones to meet a body would give it
/// more than they should.
template <class Real>
struct CountSharersPass {
  SolidBoundary<Real> boundary;
  OwnRows<const Vec4<Real>> position, velocity;
  Real dt;

  PBF_HD int row(int k) const { return boundary.near.row[k]; }
  PBF_HD void operator()(int k) const {
    const int i = row(k);
    const Vec3<Real> x = mul_add(dt, xyz(velocity[i]), xyz(position[i]));
    const SolidScene<Real>& s = *boundary.solid_scene;
    for (int solid = 0; solid < s.obstacles(); ++solid) {
      if (!s.share[solid].free || !s.solid[solid].bounds.has(x)) continue;
      const Solid<Real>& o = s.solid[solid].solid;
      const Real away = s.flat ? distance<2>(o, x) : distance<3>(o, x);
      if (!(away * s.walls.inv_range < Real(1))) continue;
      SharerSums& to = sharers_of(s, solid, i);
      add_whole(&to.pushed, 1);
      if (away < Real(0)) add_whole(&to.stopped, 1);
    }
  }
};
/// Behind it, over the bodies.
template <class Real>
struct TakeSharersPass {
  BodyRows<Real> rows;
  PBF_HD void operator()(int b) const { rows.take_sharers(b); }
};

/// Between two iterations: bodies move by their share of what the last one has given them.
template <class Real>
struct FollowFluidPass {
  BodyRows<Real> rows;

  PBF_HD void operator()(int) const {
    for (int b = 0; b < rows.bodies; ++b) {
      const double all = rows.collect(b);
      const BodyInverse& inverse = rows.step[b].inverse;
      const BodyState before = rows.state[b];
      BodyState& s = rows.state[b];
      follow(rows.kind[b], inverse, s, all);
      const BodyStep& step = rows.step[b];
      const double room = kFollowRoom + way(b, vec(step.velocity), vec(step.rate));
      const double far = away(b);
      if (far > room) {
        s = before;
        const double near = away(b);
        const double part = near < room ? all * (room - near) / (far - near) : 0;
        follow(rows.kind[b], inverse, s, part);
      }
    }
    solve_contacts(rows.kind, rows.state, rows.step, rows.bodies, rows.dt);
    for (int b = 0; b < rows.bodies; ++b) rows.move(b);
  }

 private:
  /// h: at most so far does a point of the body go in a substep.
  PBF_HD double way(int b, Vec3<double> velocity, Vec3<double> rate) const {
    return rows.dt * (square_root(dot(velocity, velocity)) +
                      rows.kind[b].radius * square_root(dot(rate, rate)));
  }
  /// h: at most so far is a point of the body from where it was predicted to be.
  PBF_HD double away(int b) const {
    const BodyState& s = rows.state[b];
    const BodyStep& step = rows.step[b];
    return way(b, vec(s.velocity) - vec(step.velocity),
               rate_by(step.inverse, vec(s.spin)) - vec(step.rate));
  }
};

/// At the end of an update, before loads are summed: what the last iteration has given, and the
/// energy that the bodies have given to the fluid.
template <class Real>
struct EndBodiesPass {
  BodyRows<Real> rows;
  Vec3<double> gravity;  ///< h/s^2
  Load* load;            ///< in/out

  PBF_HD void operator()(int b) const {
    rows.collect(b);
    rows.step[b].seen = {};
    BodyState& s = rows.state[b];
    const double energy = energy_of(rows.kind[b], s, gravity);
    load[load_row_of_solid(rows.kind[b].solid)].work += s.energy - energy;
    s.energy = energy;
  }
};

}  // namespace pbf::PBF_VARIANT
