// Particle data on the host for files and pictures: in the order of ids, SI units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace pbf::inline solver_module {

enum class ScalarType { f32, f64, i32 };

inline std::size_t size_of(ScalarType t) { return t == ScalarType::f64 ? 8 : 4; }

/// One array of a snapshot: `count` rows of `components` scalars, row-major, row i = particle id i.
struct FieldArray {
  std::string name;  ///< position, velocity, density, id
  std::string unit;  ///< m, m/s, kg/m^3, 1
  ScalarType type = ScalarType::f32;
  int components = 1;
  std::vector<std::byte> bytes;

  template <class T>
  std::span<const T> as() const {
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  template <class T>
  std::span<T> as() {
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
};

/// The state at one time. fields[0] is always "position" (3 components).
struct Snapshot {
  std::int64_t update = 0;  ///< number of updates done
  double time = 0;          ///< s
  std::size_t count = 0;    ///< particles
  std::vector<FieldArray> fields;

  const FieldArray* find(const std::string& name) const {
    for (const auto& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
};

}  // namespace pbf::inline solver_module
