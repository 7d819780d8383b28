// The number of particles of a scene in which particles come and go. It is in the memory of the
// executor, so that no pass waits for the host.
#pragma once

#include <cstdint>

#include "kernels/hd.h"

namespace pbf {

/// Rows 0 ... rows - 1 are particles. A row with a negative id leaves in the next sort.
struct RowState {
  std::int64_t rows = 0;
  std::int64_t next_id = 0;  ///< ids are never given out twice
  std::int64_t gone = 0;     ///< particles that have left
  std::int64_t refused = 0;  ///< particles for which there was no row

  /// Calls f for every number, in the order of files.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    f(s.rows), f(s.next_id), f(s.gone), f(s.refused);
  }
};

/// Images of particles beyond periodic faces (pass_images.h) have the id of the particle with this
/// bit, so that a sort puts them behind the particles of their bin.
inline constexpr int kImage = 1 << 30;
PBF_HD constexpr bool is_image(int id) { return id >= kImage; }
PBF_HD constexpr int particle_of(int id) { return id & ~kImage; }

/// Rows first ... last - 1, without those of images if `id` is not null. If `state` is not null,
/// its number of rows ends them, which is at most `last` and which only a device knows.
struct RowRange {
  int first, last;
  const int* id = nullptr;
  const RowState* state = nullptr;
  PBF_HD bool leaves_out(int i) const { return id && is_image(id[i]); }
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// After a sort, which has left out the rows with a negative id. kept: the number of the others.
struct TakeRowsPass {
  const int* kept;
  RowState* state;
  PBF_HD void operator()(int) const {
    state->gone += state->rows - *kept;
    state->rows = *kept;
  }
};

}  // namespace pbf::PBF_VARIANT
