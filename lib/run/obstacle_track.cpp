// Tracks of obstacles.
#include <algorithm>
#include <cmath>

#include "lib/program/motion.h"
#include "lib/program/motion_table.h"
#include "lib/program/motion_times.h"
#include "lib/program/obstacles.h"
#include "lib/run/motion_warnings.h"

namespace pbf::run_module {
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
  if (!has_table(m) || m.table.time.size() < 2) return times;
  const std::size_t last = piece_at(m.table, begin + s.time.end);
  for (std::size_t k = piece_at(m.table, begin); k <= last; ++k)
    for (int c = 0; c < m.table.columns; ++c)
      for (const double t : curve_piece(m.table, std::size_t(c), k).turns())
        if (t > begin && t < begin + s.time.end) times.push_back(t - begin);
  std::ranges::sort(times);
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

/// `most`: number of times in addition to those of the motion itself.
Track track_of(const Scene& s, const Obstacle& o, int most) {
  const Scene one = scene_of(s, o);
  Track track;
  track.time = o.motion ? filled(one, thinned(times_of(s, *o.motion), 4 * kLongestTrack), most)
                        : std::vector<double>{0};
  for (const double t : track.time) track.solid.push_back(solids_of(one, t)[0]);
  track.swept = extents_of(s, track.solid[0]);
  for (const Solid<double>& solid : track.solid) track.swept.add(extents_of(s, solid));
  return track;
}

}  // namespace

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

}  // namespace pbf::run_module
