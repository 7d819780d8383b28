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

/// The wave makers stand last.
enum class MotionKind {
  sine,
  velocity,
  file,
  regular_waves,
  irregular_waves,
  solitary_waves,
  focused_waves
};
enum class WaveSpectrum { jonswap, pierson_moskowitz };
enum class WaveAmplitudes { spectrum, random };
enum class SolitaryTheory { rayleigh, boussinesq };
enum class TankMotionKind { sine, file };

/// Oscillation: amplitude * ramp(t) * sin(2 pi t/period + phase).
struct Swing {
  std::optional<Double3> direction;  ///< of a displacement, amplitude in m; or ...
  std::optional<Double3> axis;       ///< ... of a rotation through `pivot`, amplitude in degrees
  std::optional<Double3> pivot;      ///< m; absent: center of the moving object
  double amplitude = 0;              ///< m or degrees
  double period = 1;                 ///< s
  double phase = 0;                  ///< degrees
  /// s, time in which the amplitude grows as (1 - cos)/2; absent: none, of waves some periods
  std::optional<double> ramp;
  bool operator==(const Swing&) const = default;
};

/// What a wave maker is to make, in addition to direction or axis, period, phase and ramp; the kind
/// decides which members are used (lib/scene/waves.h).
struct WaveKeys {
  double height = 0;            ///< m, regular: crest to trough; irregular: significant
  int order = 0;                ///< regular: of the theory, 1 or 2; 0: 2 of a piston, 1 of a flap
  std::optional<double> depth;  ///< m, of still water; absent: of the blocks on the floor
  double gain = 1;              ///< factor on the motion
  double start = 0;             ///< s, of the motion's clock
  bool breaking = false;        ///< waves that break are meant
  WaveSpectrum spectrum = WaveSpectrum::jonswap;
  double gamma = 3.3;                         ///< of the peak of jonswap
  std::optional<std::array<double, 2>> band;  ///< of frequencies, 1/period; absent: 0.4 to 3
  std::uint64_t seed = 1;                     ///< irregular: of the phases
  std::optional<double> repeat;               ///< s, irregular: a number once the scene is loaded
  WaveAmplitudes amplitudes = WaveAmplitudes::spectrum;
  SolitaryTheory theory = SolitaryTheory::rayleigh;
  std::vector<double> heights{};   ///< m, solitary
  std::vector<double> times{0.0};  ///< s after `start`, when the paddle begins each
  double crest = 0;                ///< m, focused: elevation ...
  double place = 0;                ///< ... m, at this coordinate along the direction ...
  double time = 0;                 ///< ... s after `start`, at this time
  int components = 64;
  bool operator==(const WaveKeys&) const = default;
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
struct Motion : Swing, WaveKeys {
  MotionKind kind = MotionKind::sine;
  Double3 velocity{}, angular{};  ///< velocity: m/s, degrees/s
  std::string path;               ///< file: CSV t,x,y,z or t,x,y,z,rx,ry,rz
  Place origin;                   ///< of the path, or of the motion
  MotionTable table;              ///< file and waves
  bool waits = false;  ///< stays where the run begins; not a key (lib/program/settling.h)
  bool operator==(const Motion&) const = default;
};
inline bool makes_waves(const Motion& m) { return m.kind >= MotionKind::regular_waves; }
/// Whether its pose follows from a table, which loading fills in.
inline bool has_table(const Motion& m) { return m.kind == MotionKind::file || makes_waves(m); }

/// Motion of the domain; all coordinates are relative to the domain.
struct TankMotion : Swing {
  TankMotionKind kind = TankMotionKind::sine;
  std::string path;  ///< file: CSV t,angle or t,ax,ay,az
  Place place;       ///< of the path
  MotionTable table;
  bool operator==(const TankMotion&) const = default;
};

}  // namespace pbf::scene_module
