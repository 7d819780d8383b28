// Arrays of a step, by name. Each field is an object of a type of its own, so that the compiler
// finds it among what a pass declares (needs.h).
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

namespace pbf::inline program_module {

/// How many there are of all that fields have rows for. padding: rows behind the last particle that
/// the lists of an executor may read. cells, runs, bricks, nodes: of the grids of solver.levels.
/// walls: whose loads are summed.
struct Sizes {
  std::int64_t particles = 0, padding = 0, bins = 0, cells = 0, runs = 0, bricks = 0, nodes = 0,
               walls = 0;
};
constexpr std::int64_t per_particle(const Sizes& n) { return n.particles; }
/// For fields that passes read of neighbours.
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

/// What those see who look at an update pass by pass.
struct Shown {
  const char* quantity = "";  ///< "position"; empty: nothing
  const char* unit = "1";     ///< of the internal frame
  const char* stage = "";    ///< shown as of this stage, whatever pass writes it; empty: the pass's
  bool sum = false;          ///< over neighbours: carries the rounding of its terms
  bool axial = false;        ///< a cross product: its sign depends on the hand of the axes
  bool before_sort = false;  ///< its rows are in the order before the sort
  const struct FieldInfo* row = nullptr;  ///< not null: it names each particle's row, -1: none
  double grain = 0;                       ///< in `unit`: finer steps than this it cannot make
};

struct FieldInfo {
  const char* name;
  std::int64_t (*rows)(const Sizes&);
  Life life;
  bool pair = false;  ///< two arrays: a pass that reorders or overwrites writes into the other
  Shown shown{};
  // From the type of the field.
  Type type = Type::real;
  int components = 1;
  const FieldInfo* first = nullptr;  ///< of the second array of a pair: the field of the first

  const FieldInfo& primary() const { return first ? *first : *this; }
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
/// Rows of `count` T, which consist of whole numbers of the type `Word`.
template <class T, int count = 1, class Word = T>
struct Plain : FieldInfo {
  template <class... Args>
  constexpr Plain(Args... args) : FieldInfo{args...} {
    static_assert(sizeof(Word) == 4 || sizeof(Word) == 8);
    type = sizeof(Word) == 4 ? Type::int32 : Type::int64;
    components = int(count * sizeof(T) / sizeof(Word));
  }
};

/// The second array of a pair, a field like any other. It belongs to those passes that write it: a
/// pass that declares Flips finds its results in the first.
template <auto& F>
struct Other : std::remove_cvref_t<decltype(F)> {
  constexpr Other() : std::remove_cvref_t<decltype(F)>(F) {
    static_assert(F.pair && !F.first);
    this->first = &F;
  }
};
template <auto& F>
inline constexpr Other<F> other{};

/// Those that every solver has: positions in h (w: needs.h), velocities in h/s, densities in rho0.
/// Row k belongs to particle id[k], in the order of the last sort.
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
/// Order of a sort. Executors may let it stand in the array of ids instead.
inline constexpr struct Order : Plain<int> {
} order{{"order", per_particle, Life::pass}};
inline constexpr struct BinStart : Plain<int> {
} bin_start{{"bin_start", per_bin, Life::lists}};
}  // namespace field

/// What has its memory elsewhere: the neighbor lists in the executor, what moves in the boundary.
namespace field {
inline constexpr FieldInfo no_memory(const char* name, Life life) { return {name, nullptr, life}; }
inline constexpr struct NeighborLists : FieldInfo {
} lists{no_memory("lists", Life::lists)};
inline constexpr struct MovingParts : FieldInfo {
} motion{no_memory("motion", Life::pass)};
}  // namespace field

/// "position'"
inline std::string name_of(const FieldInfo& f) {
  return std::string(f.name) + (f.first ? "'" : "");
}

}  // namespace pbf::inline program_module
