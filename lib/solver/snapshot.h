// Particle data on the host for files and pictures: in the order of ids, SI units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "lib/scene/free_body.h"

namespace pbf::solver_module {

enum class ScalarType { f32, f64, i32, i64 };

constexpr bool is_whole(ScalarType t) { return t == ScalarType::i32 || t == ScalarType::i64; }
constexpr std::size_t size_of(ScalarType t) {
  return t == ScalarType::f64 || t == ScalarType::i64 ? 8 : 4;
}

/// One array of a snapshot: `count` rows of `components` scalars, row-major, in the order of ids.
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
  /// Number k of a field of whole numbers.
  std::int64_t whole(std::size_t k) const {
    return type == ScalarType::i64 ? as<std::int64_t>()[k] : as<std::int32_t>()[k];
  }
  /// Number k of any field.
  double number(std::size_t k) const {
    if (is_whole(type)) return double(whole(k));
    return type == ScalarType::f64 ? as<double>()[k] : double(as<float>()[k]);
  }
};

/// The state at one time. fields[0] is always "position" (3 components). "id" names the particle of
/// each row: whole numbers from 0 on that ascend. Where particles appear and disappear they have
/// gaps, and `count` differs from snapshot to snapshot; otherwise row i is particle i. They are i32
/// in runs that give out no more than 2^31 ids, which saves memory and disk, and i64 in others.
struct Snapshot {
  std::int64_t update = 0;  ///< number of updates done
  double time = 0;          ///< s
  std::size_t count = 0;    ///< particles
  std::vector<FieldArray> fields;
  std::vector<BodyMotion> bodies{};  ///< of the free bodies, in the order of obstacles

  const FieldArray* find(const std::string& name) const {
    for (const auto& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
};

/// The ids of its rows.
inline std::vector<std::int64_t> ids_of(const Snapshot& s) {
  const FieldArray& id = *s.find("id");
  std::vector<std::int64_t> ids(s.count);
  for (std::size_t i = 0; i < s.count; ++i) ids[i] = id.whole(i);
  return ids;
}

}  // namespace pbf::solver_module
