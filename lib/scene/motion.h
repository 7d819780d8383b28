// Prescribed motions as plain data. lib/program/motion.h evaluates them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pbf::scene_module {

using Double3 = std::array<double, 3>;

/// Where a scene file names another file, "scene.yaml:9:30", for messages; empty if the scene was
/// not read from a file. Ignored in comparisons of scenes.
struct Place {
  std::string text;
  bool operator==(const Place&) const { return true; }
};

enum class MotionKind { sine, velocity, file };
enum class TankMotionKind { sine, file };

/// Oscillation: amplitude * ramp(t) * sin(2 pi t/period + phase).
struct Swing {
  std::optional<Double3> direction;  ///< of a displacement, amplitude in m; or ...
  std::optional<Double3> axis;       ///< ... of a rotation through `pivot`, amplitude in degrees
  std::optional<Double3> pivot;      ///< m; absent: center of the moving object
  double amplitude = 0;              ///< m or degrees
  double period = 1;                 ///< s
  double phase = 0;                  ///< degrees
  double ramp = 0;                   ///< s, time in which the amplitude grows as (1 - cos)/2
  bool operator==(const Swing&) const = default;
};

/// The table of a file: `columns` numbers per row, at increasing times. Not a key of a scene:
/// loading fills it in (lib/run/linked_files.h).
struct MotionTable {
  std::string file, sha256;  ///< where it was read, and the hash of its bytes
  int columns = 0;
  std::vector<double> time;                   ///< s
  std::vector<std::array<double, 6>> values;  ///< x y z rx ry rz; angle; ax ay az
  std::vector<std::int64_t> line{};           ///< line in the file
  bool operator==(const MotionTable&) const = default;
};

/// Motion of an obstacle from its place in the scene. `kind` decides which members are used.
struct Motion : Swing {
  MotionKind kind = MotionKind::sine;
  Double3 velocity{}, angular{};  ///< velocity: m/s, degrees/s
  std::string path;               ///< file: CSV t,x,y,z or t,x,y,z,rx,ry,rz
  Place place;                    ///< of the path
  MotionTable table;
  bool waits = false;  ///< stays where the run begins; not a key (lib/program/settling.h)
  bool operator==(const Motion&) const = default;
};

/// Motion of the domain; all coordinates are relative to the domain.
struct TankMotion : Swing {
  TankMotionKind kind = TankMotionKind::sine;
  std::string path;  ///< file: CSV t,angle or t,ax,ay,az
  Place place;       ///< of the path
  MotionTable table;
  bool operator==(const TankMotion&) const = default;
};

}  // namespace pbf::scene_module
