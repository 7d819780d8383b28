// The updates after which a run measures, writes and draws.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// The first multiple of `every` after u (u = -1: before the start).
inline std::int64_t next_multiple(std::int64_t u, std::int64_t every) {
  return (u + every) / every * every;
}

/// Numbers of updates; 0: never. Update 0 is the initial state.
struct Schedule {
  std::int64_t updates = 1;  ///< of the whole run
  std::int64_t measure_every = 0;
  std::int64_t frame_every = 0;    ///< frames of run.vtkhdf
  std::int64_t picture_every = 0;  ///< a multiple of frame_every when there are frames

  std::int64_t gauge_every = 0;  ///< readings of the gauges

  bool measures(std::int64_t u) const { return due(u, measure_every) || u == updates; }
  bool writes(std::int64_t u) const { return due(u, frame_every) || (frame_every && u == updates); }
  bool draws(std::int64_t u) const { return due(u, picture_every); }
  bool reads_gauges(std::int64_t u) const {
    return due(u, gauge_every) || (gauge_every && u == updates);
  }
  /// Whether a longer run would measure, write, draw or read here as well.
  bool has(std::int64_t u) const {
    return due(u, measure_every) || due(u, frame_every) || due(u, picture_every) ||
           due(u, gauge_every);
  }
  /// Numbers of measurements, frames, pictures and readings up to update u, including those that
  /// are due at u.
  std::int64_t measures_until(std::int64_t u) const { return count(u, measure_every, true); }
  std::int64_t frames_until(std::int64_t u) const { return count(u, frame_every, true); }
  std::int64_t pictures_until(std::int64_t u) const { return count(u, picture_every, false); }
  std::int64_t gauges_until(std::int64_t u) const { return count(u, gauge_every, true); }
  /// The number in the name of the picture of update u: that of the frame in run.vtkhdf, or of the
  /// picture if no frames are written.
  std::int64_t picture_number(std::int64_t u) const {
    return u / (frame_every > 0 ? frame_every : picture_every);
  }
  /// The update of the k-th measurement, frame and reading (from 0).
  std::int64_t update_of_measure(std::int64_t k) const { return at(k, measure_every); }
  std::int64_t update_of_frame(std::int64_t k) const { return at(k, frame_every); }
  std::int64_t update_of_gauges(std::int64_t k) const { return at(k, gauge_every); }
  /// The first update after u (u = -1: before the start) with a measurement, with a frame or
  /// picture, with a reading, or with any of them; at most the last update.
  std::int64_t next_measure(std::int64_t u) const { return next(u, measure_every); }
  std::int64_t next_output(std::int64_t u) const {
    return std::min(next(u, frame_every), next(u, picture_every));
  }
  std::int64_t next_gauges(std::int64_t u) const { return next(u, gauge_every); }
  std::int64_t next_event(std::int64_t u) const {
    return std::min({next_measure(u), next_output(u), next_gauges(u)});
  }

 private:
  std::int64_t count(std::int64_t u, std::int64_t every, bool end) const {
    if (every <= 0) return 0;
    return u / every + 1 + (end && u >= updates && u % every != 0);
  }
  std::int64_t at(std::int64_t k, std::int64_t every) const {
    return k > updates / every ? updates : k * every;
  }
  std::int64_t next(std::int64_t u, std::int64_t every) const {
    return every > 0 ? std::min(updates, next_multiple(u, every)) : updates;
  }
  static bool due(std::int64_t u, std::int64_t every) { return every > 0 && u % every == 0; }
};

/// Rounds the times of the scene to whole updates, at least 1. If frames are written, the times of
/// pictures are rounded to whole frames.
Schedule make_schedule(const Scene& scene);

/// A sentence for each time that make_schedule() changes by rounding.
std::vector<std::string> rounded_times(const Scene& scene);

}  // namespace pbf::program_module
