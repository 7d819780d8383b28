#include "lib/run/obstacle_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/program/motion.h"
#include "lib/program/motion_table.h"
#include "lib/program/motion_times.h"
#include "lib/program/obstacles.h"

namespace pbf::inline run_module {
namespace {

/// A scene with only this obstacle, enough to compute its pose.
Scene scene_of(const Scene& s, const Obstacle& o) {
  Scene one;
  one.dimensions = s.dimensions;
  one.domain = s.domain;
  one.fluid = s.fluid;
  one.time = s.time;
  one.obstacles = {o};
  return one;
}

/// Times at which speeds and accelerations are sampled, and turning points of a table's curve.
std::vector<double> times_of(const Scene& s, const Motion& m) {
  std::vector<double> times = telling_times(s, m, 0, s.time.end);
  const double begin = s.time.motion_begin;
  if (m.kind != MotionKind::file || m.table.time.size() < 2) return times;
  const std::size_t last = piece_at(m.table, begin + s.time.end);
  for (std::size_t k = piece_at(m.table, begin); k <= last; ++k)
    for (int c = 0; c < m.table.columns; ++c)
      for (const double t : curve_piece(m.table, std::size_t(c), k).turns())
        if (t > begin && t < begin + s.time.end) times.push_back(t - begin);
  std::sort(times.begin(), times.end());
  return times;
}

/// Every n-th of the times and the last one, for tables with very many rows.
std::vector<double> thinned(const std::vector<double>& times, std::size_t most) {
  const std::size_t stride = times.size() / most + 1;
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < times.size(); k += stride) out.push_back(times[k]);
  out.push_back(times.back());
  return out;
}

/// Adds times in between, so that the obstacle moves by at most a spacing from one to the next;
/// adds about `most` times at most.
std::vector<double> filled(const Scene& one, const std::vector<double>& times, int most) {
  std::vector<double> parts(times.size(), 1);
  double all = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double way = fastest_obstacle(one, times[k], times[k + 1]) * (times[k + 1] - times[k]);
    all += parts[k] = way / one.fluid.spacing;
  }
  const double share = all > most ? most / all : 1;
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const int n = std::max(1, int(std::ceil(parts[k] * share)));
    for (int i = 0; i < n; ++i) out.push_back(times[k] + (times[k + 1] - times[k]) * i / n);
  }
  out.push_back(times.back());
  return out;
}

double distance_of(const Solid<double>& o, const Vec3<double>& x, bool flat) {
  return flat ? distance<2>(o, x) : distance<3>(o, x);
}

/// Minimizes the larger of the distances of two solids in a box by the ellipsoid method (Shor
/// 1977): each cut through the center discards the half that cannot contain the minimum.
class Deepest {
 public:
  Deepest(const Solid<double>& a, const Solid<double>& b, const Extents& box, bool flat)
      : a_(a), b_(b), box_(box), flat_(flat), n_(flat ? 2 : 3) {
    for (int k = 0; k < n_; ++k) {
      const Extent& e = box_[axis(k)];
      middle_[k] = 0.5 * (e.low + e.high);
      const double half = std::max(0.5 * (e.high - e.low), 1e-9);
      spread_[k][k] = n_ * half * half;
    }
  }
  /// The minimum; negative if the solids overlap. Stops early if it is known to exceed `enough`.
  double run(double enough) {
    double best = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 200; ++step) {
      double slope[3], value = outside(slope);
      const bool in_box = value <= 0;
      if (in_box) best = std::min(best, value = deepest_here(slope));
      const double reach = cut(slope);
      if (in_box && (value - reach > enough || reach < 1e-3 * std::fabs(best) + 1e-9)) break;
      if (reach == 0) break;
    }
    return best;
  }

 private:
  std::size_t axis(int k) const { return std::size_t(flat_ ? 2 * k : k); }
  Vec3<double> place(const double* at) const {
    return flat_ ? Vec3<double>{at[0], 0, at[1]} : Vec3<double>{at[0], at[1], at[2]};
  }
  /// How far the center is outside the box; 0 inside.
  double outside(double* slope) const {
    double worst = 0;
    for (int k = 0; k < n_; ++k) slope[k] = 0;
    for (int k = 0; k < n_; ++k) {
      const Extent& e = box_[axis(k)];
      const double below = e.low - middle_[k], above = middle_[k] - e.high;
      if (std::max(below, above) <= worst) continue;
      worst = std::max(below, above);
      for (int l = 0; l < n_; ++l) slope[l] = 0;
      slope[k] = above > below ? 1 : -1;
    }
    return worst;
  }
  double deepest_here(double* slope) const {
    const Vec3<double> x = place(middle_);
    const double of_a = distance_of(a_, x, flat_), of_b = distance_of(b_, x, flat_);
    const Solid<double>& o = of_a >= of_b ? a_ : b_;
    const Vec3<double> n = flat_ ? normal<2>(o, x) : normal<3>(o, x);
    slope[0] = n.x, slope[1] = flat_ ? n.z : n.y, slope[2] = n.z;
    return std::max(of_a, of_b);
  }
  /// Keeps the half in the direction of descent. Returns a bound on the decrease in it.
  double cut(const double* slope) {
    double along[3] = {}, square = 0;
    for (int k = 0; k < n_; ++k)
      for (int l = 0; l < n_; ++l) along[k] += spread_[k][l] * slope[l];
    for (int k = 0; k < n_; ++k) square += slope[k] * along[k];
    if (!(square > 0)) return 0;
    const double reach = std::sqrt(square), n = n_;
    for (int k = 0; k < n_; ++k) middle_[k] -= along[k] / (reach * (n + 1));
    for (int k = 0; k < n_; ++k)
      for (int l = 0; l < n_; ++l)
        spread_[k][l] =
            n * n / (n * n - 1) * (spread_[k][l] - 2 / (n + 1) * along[k] * along[l] / square);
    return reach;
  }

  const Solid<double>&a_, &b_;
  Extents box_;
  bool flat_;
  int n_;
  double middle_[3] = {}, spread_[3][3] = {};
};

/// `most`: number of times in addition to those of the motion itself.
Track track_of(const Scene& s, const Obstacle& o, int most) {
  const Scene one = scene_of(s, o);
  Track track;
  track.time = o.motion ? filled(one, thinned(times_of(s, *o.motion), 4 * kLongestTrack), most)
                        : std::vector<double>{0};
  for (const double t : track.time) track.solid.push_back(solids_of(one, t)[0]);
  track.swept = extents_of(track.solid[0]);
  for (const Solid<double>& solid : track.solid) {
    const Extents e = extents_of(solid);
    for (std::size_t k = 0; k < 3; ++k)
      track.swept[k] = {std::min(track.swept[k].low, e[k].low),
                        std::max(track.swept[k].high, e[k].high)};
  }
  return track;
}

}  // namespace

Extents extents_of(const Solid<double>& o) {
  const double center[3] = {o.center.x, o.center.y, o.center.z};
  Extents out;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3<double> up{double(k == 0), double(k == 1), double(k == 2)};
    out[k] = {center[k] - reach_along(o, -1.0 * up, false), center[k] + reach_along(o, up, false)};
  }
  return out;
}

Extents extents_of(const Scene& s) {
  Extents out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = {0, (s.domain.max[k] - s.domain.min[k]) / s.h()};
  if (s.plane()) out[1] = {0, 0};
  return out;
}

Solid<double> solid_at(const Scene& s, const Obstacle& o, double time) {
  return solids_of(scene_of(s, o), time)[0];
}

std::vector<Track> tracks_of(const Scene& s) {
  const double pairs = double(s.obstacles.size()) * double(s.obstacles.size());
  const int most = int(std::clamp(2e6 / std::max(1.0, pairs), 64.0, double(kLongestTrack)));
  std::vector<Track> all;
  for (const Obstacle& o : s.obstacles) all.push_back(track_of(s, o, most));
  return all;
}

double shared_thickness(const Scene& s, const Solid<double>& a, const Solid<double>& b,
                        double least) {
  const Extents of_a = extents_of(a), of_b = extents_of(b);
  Extents box = extents_of(s);
  for (std::size_t k = 0; k < 3; ++k) {
    if (s.plane() && k == 1) continue;
    box[k] = {std::max({box[k].low, of_a[k].low, of_b[k].low}),
              std::min({box[k].high, of_a[k].high, of_b[k].high})};
    if (box[k].low > box[k].high) return 0;
  }
  const double depth = Deepest(a, b, box, bool(s.plane())).run(-0.5 * least);
  return -2 * depth >= least ? -2 * depth : 0;
}

}  // namespace pbf::inline run_module
