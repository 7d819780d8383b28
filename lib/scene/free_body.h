// An obstacle that the fluid moves, as plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lib/scene/vector3.h"

namespace pbf::scene_module {

/// What a free body may be kept from: motions along the axes of the scene, turns about them.
inline constexpr std::array<const char*, 6> kLockNames{"x", "y", "z", "rx", "ry", "rz"};

/// How a free body moves at one time, along the axes of the scene.
struct BodyMotion {
  Double3 middle{};       ///< m, Obstacle::middle()
  Matrix3 turn = kUnit3;  ///< from its pose in the scene file: x -> turn x
  Double3 velocity{};     ///< m/s, of the center of its mass
  Double3 spin{};         ///< rad/s
  bool operator==(const BodyMotion&) const = default;

  static constexpr int kNumbers = 18;
  /// Calls f for every number, in the order of columns (lib/program/column.h) and files.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    for (auto& x : s.middle) f(x);
    for (auto& row : s.turn)
      for (auto& x : row) f(x);
    for (auto& x : s.velocity) f(x);
    for (auto& x : s.spin) f(x);
  }
};

/// The keys of `free`.
struct FreeBody {
  std::optional<double> density;  ///< kg/m^3; absent: from the mass
  std::optional<double> mass;     ///< kg, in two dimensions kg/m; absent: from the density
  std::vector<std::string> lock;  ///< of kLockNames
  Double3 velocity{};             ///< m/s, at the start
  Double3 angular{};              ///< degrees/s, at the start
  /// Where it is; absent: at its place in the scene file. Not a key (lib/program/free_bodies.h).
  std::optional<BodyMotion> now{};
  bool operator==(const FreeBody&) const = default;

  /// kg/m^3, of a body of so many m^3 (m^2 in two dimensions).
  double density_in(double volume) const { return density ? *density : mass.value_or(0) / volume; }
  bool locks(const char* what) const {
    for (const std::string& one : lock)
      if (one == what) return true;
    return false;
  }
};

}  // namespace pbf::scene_module
