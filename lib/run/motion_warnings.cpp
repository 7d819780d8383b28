#include "lib/run/motion_warnings.h"

#include <fmt/core.h>
#include <algorithm>
#include <iterator>
#include <optional>

#include "lib/program/motion.h"
#include "lib/scene/difference.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {
namespace {

// -------------------------------------------------------------------------------------- walls

/// Distances behind a wall, m, of an obstacle's far side and of its near side.
struct Behind {
  double far, near;
};
Behind behind(const Scene& s, const Solid<double>& solid, int face) {
  const auto axis = std::size_t(face / 2);
  const BodyBox e = extents_of(s, solid);
  const double size = extents_of(s).high[axis], h = s.h();
  if (face % 2 == 1) return {(e.high[axis] - size) * h, (e.low[axis] - size) * h};
  return {-e.low[axis] * h, -e.high[axis] * h};
}

/// The wall above, that is, opposite to gravity; -1 without gravity.
int top_of(const Scene& s) {
  const int axis = level_axis(s);
  const double g = s.gravity[std::size_t(axis)];
  return g == 0 ? -1 : 2 * axis + (g < 0 ? 1 : 0);
}

/// Whether an obstacle that only rotates has its pivot at the wall.
bool is_hinged(const Scene& s, const Obstacle& o, int face) {
  const Motion& m = *o.motion;
  const bool turns = m.kind == MotionKind::sine || makes_waves(m) ? m.axis.has_value()
                     : m.kind == MotionKind::velocity             ? length(m.velocity) == 0
                                                                  : false;
  if (!turns) return false;
  const auto axis = std::size_t(face / 2);
  const double at = m.pivot.value_or(o.middle())[axis];
  const double wall = (face % 2 == 1 ? s.domain.max : s.domain.min)[axis];
  return (face % 2 == 1 ? wall - at : at - wall) <= s.fluid.spacing;
}

/// Bisection between `good` and `bad`: the first time at which f holds; s.
template <class F>
double onset(double good, double bad, F&& f) {
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (good + bad);
    (f(middle) ? bad : good) = middle;
  }
  return bad;
}

struct Crossing {
  bool leaves = false;                 ///< the whole obstacle is behind the wall
  double by = 0, worst = 0, from = 0;  ///< m; s: time of the maximum, and of the onset
};

/// An obstacle that cuts the wall from the start may go on in it, and is told when all of it is
/// behind the wall; any other when a part of it is.
std::optional<Crossing> crossing(const Scene& s, const Obstacle& o, const Track& track, int face) {
  const Behind at_start = behind(s, track.solid[0], face);
  Crossing c;
  c.leaves = at_start.far > s.fluid.spacing;
  // A near side behind the wall: it comes in from outside.
  if (c.leaves ? at_start.near > 0 : is_hinged(s, o, face)) return std::nullopt;
  const auto depth = [&](const Solid<double>& solid) {
    const Behind b = behind(s, solid, face);
    return c.leaves ? b.near : b.far;
  };
  for (std::size_t k = 0; k < track.time.size(); ++k)
    if (const double now = depth(track.solid[k]); now > c.by) c.by = now, c.worst = track.time[k];
  const double from = c.leaves ? 0 : std::max(0.0, at_start.far), limit = from + s.fluid.spacing;
  if (!(c.by > limit)) return std::nullopt;
  const auto is_behind = [&](double t) {
    return depth(solid_at(s, o, t)) > from + 1e-6 * s.fluid.spacing;
  };
  std::size_t k = 0;
  while (depth(track.solid[k]) <= limit) ++k;
  // Go back to the last time before it reached the wall.
  std::size_t before = k;
  while (before > 0 && is_behind(track.time[before])) --before;
  c.from = onset(track.time[before], track.time[std::min(before + 1, k)], is_behind);
  return c;
}

std::string motion_remedy(const Obstacle& o, bool leaves) {
  if (leaves && o.motion->kind == MotionKind::sine)
    return "lower motion.amplitude, or make the obstacle longer";
  switch (o.motion->kind) {
    case MotionKind::sine:
      return o.motion->direction ? "lower motion.amplitude, or move the obstacle away from the wall"
                                 : "lower motion.amplitude, or make the obstacle shorter";
    case MotionKind::velocity:
      return length(o.motion->velocity) == 0
                 ? "make the obstacle shorter, or move it away from the wall"
                 : "end the run earlier, or give a table that stops it (motion: {kind: file})";
    case MotionKind::file:
      break;
    default:
      return "lower the waves, or make the obstacle longer";
  }
  return "change the rows of its table";
}

std::string wall_text(const Scene& s, std::size_t k, const Track& track) {
  const Obstacle& o = s.obstacles[k];
  std::string text;
  double most = 0;
  for (int face = 0; face < 6; ++face) {
    if ((s.plane() && face / 2 == 1) || !s.domain.has_wall(face / 2, face % 2 == 1) ||
        face == top_of(s))
      continue;
    const std::optional<Crossing> c = crossing(s, o, track, face);
    if (!c || c->by <= most) continue;
    most = c->by;
    const char* wall = kFaceNames[std::size_t(face)];
    text =
        named(s, k) +
        (c->leaves
             ? fmt::format(" leaves the tank through the wall {} at {:.4g} s, and is up to {:.2g} "
                           "m behind it (at {:.4g} s); ",
                           wall, c->from, c->by, c->worst)
             : fmt::format(
                   " goes through the wall {} from {:.4g} s on, by up to {:.2g} m (at {:.4g} s); ",
                   wall, c->from, c->by, c->worst)) +
        motion_remedy(o, c->leaves);
  }
  return text;
}

// --------------------------------------------------------------------------------- collisions

struct Meeting {
  double thickness = 0, worst = 0, from = 0;  ///< m; s
  bool at_start = false;
};

class Meetings {
 public:
  Meetings(const Scene& s, const std::vector<Track>& tracks)
      : s_(s), tracks_(tracks), least_(0.5 * s.fluid.spacing / s.h()) {}

  std::optional<Meeting> of(std::size_t a, std::size_t b) const {
    if (!tracks_[a].swept.meets(tracks_[b].swept, 0)) return std::nullopt;
    Meeting m;
    if (shared(a, b, 0) > 0) {
      if (!is_bounded(tracks_[a].solid[0]) || !is_bounded(tracks_[b].solid[0])) return std::nullopt;
      return Meeting{shared(a, b, 0), 0, 0, true};
    }
    double before = 0;
    bool met = false;
    for (const double t : times(a, b)) {
      const double thick = shared(a, b, t);
      if (thick > m.thickness) m.thickness = thick, m.worst = t;
      if (thick > 0 && !met)
        met = true, m.from = onset(before, t, [&](double x) { return shared(a, b, x) > 0; });
      before = t;
    }
    return met ? std::optional(m) : std::nullopt;
  }

 private:
  std::vector<double> times(std::size_t a, std::size_t b) const {
    std::vector<double> all;
    std::ranges::set_union(tracks_[a].time, tracks_[b].time, std::back_inserter(all));
    return all;
  }
  Solid<double> at(std::size_t k, double time) const {
    const Track& track = tracks_[k];
    const auto found = std::lower_bound(track.time.begin(), track.time.end(), time);
    if (track.time.size() == 1) return track.solid[0];
    if (found != track.time.end() && *found == time)
      return track.solid[std::size_t(found - track.time.begin())];
    return solid_at(s_, s_.obstacles[k], time);
  }
  double shared(std::size_t a, std::size_t b, double time) const {
    return shared_thickness(s_, at(a, time), at(b, time), least_) * s_.h();
  }

  const Scene& s_;
  const std::vector<Track>& tracks_;
  double least_;  ///< h
};

}  // namespace

std::string named(const Scene& s, std::size_t k) {
  return fmt::format("obstacles[{}] ({})", k, s.obstacles[k].name);
}

std::string walls_text(const Scene& s, const std::vector<Track>& tracks) {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < s.obstacles.size(); ++k)
    if (s.obstacles[k].motion && is_bounded(tracks[k].solid[0]))
      texts.push_back(wall_text(s, k, tracks[k]));
  std::erase(texts, "");
  return first_of(texts, kShown);
}

std::string collisions_text(const Scene& s, const std::vector<Track>& tracks) {
  const std::size_t n = s.obstacles.size();
  const Meetings meetings(s, tracks);
  std::vector<std::string> texts, later;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      const std::optional<Meeting> m = meetings.of(a, b);
      if (!m) continue;
      const std::string both = named(s, a) + " and " + named(s, b);
      if (m->at_start)
        texts.push_back(both + fmt::format(" overlap by {:.2g} m at the start", m->thickness));
      else
        later.push_back(
            both +
            fmt::format(
                " run into each other at {:.4g} s and overlap by up to {:.2g} m (at {:.4g} s)",
                m->from, m->thickness, m->worst));
    }
  texts.insert(texts.end(), later.begin(), later.end());
  if (texts.empty()) return "";
  return first_of(texts, kShown) +
         "; fluid beside the place feels both of them: let them touch, or keep them apart";
}

}  // namespace pbf::run_module
