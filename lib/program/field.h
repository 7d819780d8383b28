// Arrays of a step, by name. Each field is an object of its own type, so that the compiler can find
// it in the declarations of a pass (needs.h). All memory that passes touch is a field.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "kernels/row_state.h"
#include "kernels/step_counts.h"
#include "kernels/vec3.h"
#include "lib/scene/backend.h"

namespace pbf::scene_module {
struct Scene;
}

namespace pbf::program_module {

struct Plan;

/// What determines how many rows a field has. particles: at most (Plan::capacity); padding: rows
/// after those, which the lists of an executor may read.
struct Sizes {
  const Scene& scene;
  const Plan& plan;
  std::int64_t particles, padding, bins;
};
constexpr std::int64_t one_row(const Sizes&) { return 1; }
constexpr std::int64_t per_particle(const Sizes& n) { return n.particles; }
/// For fields of which passes read the rows of neighbors.
constexpr std::int64_t per_padded_row(const Sizes& n) { return n.particles + n.padding; }
constexpr std::int64_t per_bin(const Sizes& n) { return n.bins + 1; }

enum class Type { real, int32, int64, object };  ///< of a component; real: of the scene's precision

/// How long the contents count: until the next pass that writes them; as long as the lists; as long
/// as the solver (run); within an update, 0 between two; along with the particles (rows); or as
/// part of the state, which is also kept, saved and set. Those after `run` begin as zeros.
enum class Life { pass, lists, run, update, rows, state };

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
  int components = 1;                ///< 0: objects, whose size is that of a row
  std::array<int, 2> row_bytes{};    ///< by Precision
  const FieldInfo* first = nullptr;  ///< for the second array of a pair: the field of the first
  int numbers = 0;                   ///< that a row has in a SolverState; 0: it cannot be there
  void (*to_numbers)(const void* row, double* numbers) = nullptr;    ///< null: its components
  void (*from_numbers)(const double* numbers, void* row) = nullptr;  ///< the same

  const FieldInfo& primary() const { return first ? *first : *this; }
  int bytes(Precision p) const { return row_bytes[std::size_t(p)]; }
  /// Row k belongs to the particle of row k.
  bool is_per_particle() const { return rows == per_particle || rows == per_padded_row; }
  /// Rows without padding.
  std::int64_t kept_rows(const Sizes& n) const { return is_per_particle() ? n.particles : rows(n); }
  /// One of two arrays that every sort reorders like the particles.
  constexpr bool is_carried() const {
    return pair && !first && (life == Life::rows || life == Life::state);
  }
};

/// Rows of x, y, z, w. A state has no w: after a state was set it is 1 for positions, else 0.
struct Vectors : FieldInfo {
  template <class... Args>
  constexpr Vectors(Args... args) : FieldInfo{args...} {
    components = 4;
    row_bytes = {sizeof(Vec4<float>), sizeof(Vec4<double>)};
    numbers = 3;
  }
};
/// Rows of one real number.
struct Numbers : FieldInfo {
  template <class... Args>
  constexpr Numbers(Args... args) : FieldInfo{args...} {
    row_bytes = {sizeof(float), sizeof(double)};
    numbers = 1;
  }
};
/// The number of type T nearest to x; 0 if x is not a number.
template <class T>
T from_number(double x) {
  if constexpr (std::is_floating_point_v<T>) return T(x);
  constexpr T least = std::numeric_limits<T>::lowest(), most = std::numeric_limits<T>::max();
  if (!(x > double(least))) return x <= double(least) ? least : T(0);
  return x >= double(most) ? most : T(x);
}

/// Rows of `count` objects T of words of type `Word`. If T::each(t, f) calls f for every number of
/// t, the field may be part of the state. The numbers must be exact as double.
template <class T, int count = 1, class Word = T>
struct Plain : FieldInfo {
  template <class... Args>
  constexpr Plain(Args... args) : FieldInfo{args...} {
    components = 0;
    type = Type::object;
    row_bytes = {int(count * sizeof(T)), int(count * sizeof(T))};
    if constexpr (std::is_integral_v<Word>) {
      static_assert(sizeof(Word) == 4 || sizeof(Word) == 8);
      type = sizeof(Word) == 4 ? Type::int32 : Type::int64;
      components = int(count * sizeof(T) / sizeof(Word));
    }
    if constexpr (std::is_integral_v<T> && count == 1) {
      numbers = 1;
      to_numbers = [](const void* row, double* to) { *to = double(*static_cast<const T*>(row)); };
      from_numbers = [](const double* from, void* row) {
        *static_cast<T*>(row) = from_number<T>(*from);
      };
    } else if constexpr (requires(T t) { T::each(t, [](auto&) {}); }) {
      T any{};
      T::each(any, [&](auto&) { ++numbers; });
      to_numbers = [](const void* row, double* to) {
        T::each(*static_cast<const T*>(row), [&](const auto& x) { *to++ = double(x); });
      };
      from_numbers = [](const double* from, void* row) {
        T::each(*static_cast<T*>(row),
                [&](auto& x) { x = from_number<std::remove_reference_t<decltype(x)>>(*from++); });
      };
    }
  }
};
/// Rows of a type T<Real>. Its header says which: T<Real> row_of<Real>(const F&)
/// (lib/solver/step_context.h).
struct Objects : FieldInfo {
  template <class... Args>
  constexpr Objects(std::array<int, 2> bytes, Args... args) : FieldInfo{args...} {
    type = Type::object;
    components = 0;
    row_bytes = bytes;
  }
};
template <template <class> class T>
constexpr std::array<int, 2> kBytesOf = {sizeof(T<float>), sizeof(T<double>)};

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
/// Velocity without the push of the constraints in the last step, h/s. Only with time steps of
/// second order. Sorts move it as they move velocities.
inline constexpr struct FreeVelocity : Vectors {
} free_velocity{
    {"free velocity", per_padded_row, Life::state, true, Shown{"velocity without pushes", "h/s"}}};
inline constexpr struct Density : Numbers {
} density{{"density", per_particle, Life::pass, false, Shown{"density", "rho0", "density", true}}};
inline constexpr struct Id : Plain<int> {
} id{{"id", per_particle, Life::state, true}};
inline constexpr struct Counts : Plain<StepCounts> {
} counts{{"counts", one_row, Life::state}};
/// Where the number of particles changes.
inline constexpr struct RowNumber : Plain<RowState> {
} row_state{{"rows", one_row, Life::state}};
inline constexpr struct Bin : Plain<int> {
} bin{{"bin", per_particle, Life::pass, false, Shown{.quantity = "bin", .before_sort = true}}};
/// Order of a sort. Executors may store it in the array of ids instead.
inline constexpr struct Order : Plain<int> {
} order{{"order", per_particle, Life::pass}};
inline constexpr struct BinStart : Plain<int> {
} bin_start{{"bin_start", per_bin, Life::lists}};
/// Their memory is the executor's.
inline constexpr struct NeighborLists : FieldInfo {
} lists{{"lists", nullptr, Life::lists}};

constexpr bool is_basic(const FieldInfo& f) {
  return &f == &position || &f == &velocity || &f == &id;
}
/// Whether sorts carry the field besides those that their pass moves itself.
constexpr bool is_carried_field(const FieldInfo& f) {
  return f.is_carried() && !is_basic(f) && &f != &free_velocity;
}
}  // namespace field

/// "position", or "position'" for the second array.
inline std::string name_of(const FieldInfo& f) {
  return std::string(f.name) + (f.first ? "'" : "");
}

}  // namespace pbf::program_module
