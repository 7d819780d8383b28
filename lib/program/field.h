// Arrays of a step, by name. Each field is an object of its own type, so that the compiler can find
// it in the declarations of a pass (needs.h).
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

namespace pbf::inline program_module {

/// Numbers that determine how many rows a field has. padding: rows after the last particle, which
/// the lists of an executor may read. cells, runs, bricks, nodes: of the grids of solver.levels.
/// walls: those whose loads are summed.
struct Sizes {
  std::int64_t particles = 0, padding = 0, bins = 0, cells = 0, runs = 0, bricks = 0, nodes = 0,
               walls = 0;
};
constexpr std::int64_t per_particle(const Sizes& n) { return n.particles; }
/// For fields of which passes read the rows of neighbors.
constexpr std::int64_t per_padded_row(const Sizes& n) { return n.particles + n.padding; }
constexpr std::int64_t per_bin(const Sizes& n) { return n.bins + 1; }
constexpr std::int64_t per_cell(const Sizes& n) { return n.cells; }
constexpr std::int64_t per_run(const Sizes& n) { return n.runs; }
constexpr std::int64_t per_brick(const Sizes& n) { return n.bricks; }
constexpr std::int64_t per_node(const Sizes& n) { return n.nodes; }
constexpr std::int64_t per_wall(const Sizes& n) { return n.walls; }

enum class Type { real, int32, int64 };  ///< of a component; real: of the scene's precision

/// How long the contents count: until the next pass that writes them; as long as the lists; within
/// an update, empty between two; along with the particles (rows); or as part of the state, which is
/// also saved and kept.
enum class Life { pass, lists, update, rows, state };

/// How a trace of an update, pass by pass, shows the field.
struct Shown {
  const char* quantity = "";  ///< "position"; empty: not shown
  const char* unit = "1";     ///< of the internal frame
  const char* stage = "";     ///< shown under this stage; empty: under that of the writing pass
  bool sum = false;           ///< a sum over neighbors, with the rounding errors of its terms
  bool axial = false;         ///< a cross product: its sign depends on the handedness of the axes
  bool before_sort = false;   ///< its rows are in the order before the sort
  const struct FieldInfo* row = nullptr;  ///< not null: field with each particle's row, -1: none
  double grain = 0;                       ///< resolution of the values, in `unit`
};

struct FieldInfo {
  const char* name;
  std::int64_t (*rows)(const Sizes&);
  Life life;
  bool pair = false;  ///< two arrays: a pass that reorders rows writes into the other one
  Shown shown{};
  // Set by the derived types.
  Type type = Type::real;
  int components = 1;
  const FieldInfo* first = nullptr;  ///< for the second array of a pair: the field of the first

  const FieldInfo& primary() const { return first ? *first : *this; }
  /// real: bytes of a real number.
  std::int64_t row_bytes(std::int64_t real) const {
    return components * (type == Type::real ? real : type == Type::int64 ? 8 : 4);
  }
};

/// Rows of x, y, z, w.
struct Vectors : FieldInfo {
  template <class... Args>
  constexpr Vectors(Args... args) : FieldInfo{args...} {
    components = 4;
  }
};
/// Rows of one real number.
struct Numbers : FieldInfo {
  template <class... Args>
  constexpr Numbers(Args... args) : FieldInfo{args...} {}
};
/// Rows of `count` objects T, which consist of integers of type `Word`.
template <class T, int count = 1, class Word = T>
struct Plain : FieldInfo {
  template <class... Args>
  constexpr Plain(Args... args) : FieldInfo{args...} {
    static_assert(sizeof(Word) == 4 || sizeof(Word) == 8);
    type = sizeof(Word) == 4 ? Type::int32 : Type::int64;
    components = int(count * sizeof(T) / sizeof(Word));
  }
};

/// The second array of a pair. Passes declare it like any other field. After a flip (Flips in
/// needs.h) it is the first.
template <auto& F>
struct Other : std::remove_cvref_t<decltype(F)> {
  constexpr Other() : std::remove_cvref_t<decltype(F)>(F) {
    static_assert(F.pair && !F.first);
    this->first = &F;
  }
};
template <auto& F>
inline constexpr Other<F> other{};

/// Fields of every solver: positions in h (w: needs.h), velocities in h/s, densities in rho0. Rows
/// are in the order of the last sort; row k belongs to particle id[k].
namespace field {
inline constexpr struct Position : Vectors {
} position{{"position", per_padded_row, Life::state, true, Shown{"position", "h"}}};
inline constexpr struct Velocity : Vectors {
} velocity{{"velocity", per_padded_row, Life::state, true, Shown{"velocity", "h/s"}}};
inline constexpr struct Density : Numbers {
} density{{"density", per_particle, Life::pass, false, Shown{"density", "rho0", "density", true}}};
inline constexpr struct Id : Plain<int> {
} id{{"id", per_particle, Life::state, true}};
inline constexpr struct Bin : Plain<int> {
} bin{{"bin", per_particle, Life::pass, false, Shown{.quantity = "bin", .before_sort = true}}};
/// Order of a sort. Executors may store it in the array of ids instead.
inline constexpr struct Order : Plain<int> {
} order{{"order", per_particle, Life::pass}};
inline constexpr struct BinStart : Plain<int> {
} bin_start{{"bin_start", per_bin, Life::lists}};
}  // namespace field

/// Fields with their memory elsewhere: in the executor (lists) and in the boundary (moving solids).
namespace field {
inline constexpr FieldInfo no_memory(const char* name, Life life) { return {name, nullptr, life}; }
inline constexpr struct NeighborLists : FieldInfo {
} lists{no_memory("lists", Life::lists)};
inline constexpr struct MovingParts : FieldInfo {
} motion{no_memory("motion", Life::pass)};
}  // namespace field

/// "position", or "position'" for the second array.
inline std::string name_of(const FieldInfo& f) {
  return std::string(f.name) + (f.first ? "'" : "");
}

}  // namespace pbf::inline program_module
