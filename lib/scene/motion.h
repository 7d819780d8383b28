// Prescribed motions as plain data. lib/program/motion.h evaluates them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pbf::inline scene_module {

using Double3 = std::array<double, 3>;

/// Where a scene file names another one, "scene.yaml:9:30", for messages; empty in a scene that was
/// not read. No part of what the scene says: two that differ in it are equal.
struct Place {
  std::string text;
  bool operator==(const Place&) const { return true; }
};

enum class MotionKind { sine, velocity, file };
enum class TankMotionKind { sine, file };

/// To and fro: amplitude * ramp(t) * sin(2 pi t/period + phase).
struct Swing {
  std::optional<Double3> direction;  ///< along it, amplitude in m; or ...
  std::optional<Double3> axis;       ///< ... about it, through `pivot`, amplitude in degrees
  std::optional<Double3> pivot;      ///< m; absent: the middle of what moves
  double amplitude = 0;              ///< m or degrees
  double period = 1;                 ///< s
  double phase = 0;                  ///< degrees
  double ramp = 0;                   ///< s, in which the amplitude grows by (1 - cos)/2
  bool operator==(const Swing&) const = default;
};

/// The table of a file: `columns` numbers in each row, at times that grow. No key of a scene: who
/// loads one fills it in (lib/run/motion_files.h).
struct MotionTable {
  std::string file, sha256;  ///< where it was read, and its bytes
  int columns = 0;
  std::vector<double> time;                   ///< s
  std::vector<std::array<double, 6>> values;  ///< x y z rx ry rz; angle; ax ay az
  std::vector<std::int64_t> line{};           ///< of the file
  bool operator==(const MotionTable&) const = default;
};

/// Of an obstacle, from where the scene puts it. Which members count depends on `kind`.
struct Motion : Swing {
  MotionKind kind = MotionKind::sine;
  Double3 velocity{}, angular{};  ///< velocity: m/s, degrees/s
  std::string path;               ///< file: CSV t,x,y,z or t,x,y,z,rx,ry,rz
  Place place;                    ///< of the path
  MotionTable table;
  bool operator==(const Motion&) const = default;
};

/// Of the domain, in which everything else is told.
struct TankMotion : Swing {
  TankMotionKind kind = TankMotionKind::sine;
  std::string path;  ///< file: CSV t,angle or t,ax,ay,az
  Place place;       ///< of the path
  MotionTable table;
  bool operator==(const TankMotion&) const = default;
};

}  // namespace pbf::inline scene_module
