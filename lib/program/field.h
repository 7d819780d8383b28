// Arrays of a step, by name. A program lists the arrays that its passes read or write. All code
// that allocates, counts, prints or saves arrays uses that list.
#pragma once

#include <cstdint>
#include <vector>

namespace pbf::inline program_module {

enum class Type { real, int32, int64 };  ///< real: of the scene's precision

/// How many rows a field has. padded: one per particle, and behind them what the lists of an
/// executor may read beyond the last one. cells, runs, bricks, nodes: of the grids of
/// solver.levels. walls: whose loads are summed.
enum class Rows { particles, padded, bins, cells, runs, bricks, nodes, walls };

/// How many of each there are. padding: of the executor.
struct RowCounts {
  std::int64_t particles = 0, padding = 0, bins = 0, cells = 0, runs = 0, bricks = 0, nodes = 0,
               walls = 0;
};

struct FieldInfo {
  const char* name;
  Type type;
  int components;
  Rows rows;
  bool doubled = false;  ///< two arrays: a pass that reorders or overwrites writes into the other
  bool state = false;    ///< part of the state: saved, kept, and brought along by the sort
};

/// Those that every solver has: positions in h (w: 1, then what a pass puts there), velocities in
/// h/s, densities in rho0. Row k belongs to particle id[k], in the order of the last sort.
namespace field {
inline constexpr FieldInfo position{"position", Type::real, 4, Rows::padded, true, true};
inline constexpr FieldInfo velocity{"velocity", Type::real, 4, Rows::padded, true, true};
inline constexpr FieldInfo density{"density", Type::real, 1, Rows::particles};
inline constexpr FieldInfo id{"id", Type::int32, 1, Rows::particles, true, true};
inline constexpr FieldInfo bin{"bin", Type::int32, 1, Rows::particles};
/// Order of a sort. Executors may let it stand in the other array of ids instead.
inline constexpr FieldInfo order{"order", Type::int32, 1, Rows::particles};
inline constexpr FieldInfo bin_start{"bin_start", Type::int32, 1, Rows::bins};
/// The neighbour lists: their memory is the executor's.
inline constexpr FieldInfo lists{"lists", Type::int32, 0, Rows::particles};
/// What moves by itself: its memory is that of the boundary.
inline constexpr FieldInfo motion{"motion", Type::int32, 0, Rows::particles};
}  // namespace field

/// Rows of one of its arrays.
constexpr std::int64_t rows_of(const FieldInfo& f, const RowCounts& n) {
  switch (f.rows) {
    case Rows::particles:
      break;
    case Rows::padded:
      return n.particles + n.padding;
    case Rows::bins:
      return n.bins + 1;
    case Rows::cells:
      return n.cells;
    case Rows::runs:
      return n.runs;
    case Rows::bricks:
      return n.bricks;
    case Rows::nodes:
      return n.nodes;
    case Rows::walls:
      return n.walls;
  }
  return n.particles;
}

/// A field that a pass reads or writes. other: the second of its two arrays, "position'".
struct Access {
  const FieldInfo* field;
  bool other = false;
};
inline Access other(const FieldInfo& f) { return {&f, true}; }

}  // namespace pbf::inline program_module
