// When a run measures, writes and draws, in whole updates.
#pragma once

#include <cstdint>

#include "lib/scene/scene.h"

namespace pbf {

/// Numbers of updates; 0: never. Update 0 is the initial state.
struct Schedule {
  std::int64_t updates = 1;  ///< of the whole run
  std::int64_t measure_every = 0;
  std::int64_t frame_every = 0;    ///< frames of run.h5
  std::int64_t picture_every = 0;  ///< a multiple of frame_every when there are frames

  bool measures(std::int64_t u) const { return due(u, measure_every) || u == updates; }
  bool writes(std::int64_t u) const { return due(u, frame_every) || (frame_every && u == updates); }
  bool draws(std::int64_t u) const { return due(u, picture_every); }
  /// The first update after u at which something is due, at most the last one.
  std::int64_t next_event(std::int64_t u) const;

 private:
  static bool due(std::int64_t u, std::int64_t every) { return every > 0 && u % every == 0; }
};

/// Rounds the scene's times to whole updates, at least 1.
Schedule make_schedule(const Scene& scene);

}  // namespace pbf
