// A scene as plain data: all input of a run, in SI units, with defaults.
// The table of keys (keys_*.cpp) maps every field below to its YAML key, range and help text.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/scene/coloring.h"
#include "lib/scene/compare.h"
#include "lib/scene/emitter.h"
#include "lib/scene/gauge.h"
#include "lib/scene/motion.h"
#include "lib/scene/obstacle.h"

namespace pbf::scene_module {

enum class Shape { block, sphere, random_box, file, cylinder, mesh };
enum class KernelMode { consistent, paper };         ///< density kernel and gradient kernel
enum class ConstraintMode { one_sided, two_sided };  ///< C = max(rho/rho0 - 1, 0) or rho/rho0 - 1
enum class BoundaryMode { density, clamp };          ///< walls with a density contribution, or bare
enum class SolverMethod { jacobi, chebyshev };       ///< omega: constant, or a Chebyshev sequence
/// Corrections over grids coarser than h (kernels/README.md, "Levels"); automatic: in deep fluid.
enum class LevelsMode { off, automatic, on };
enum class Compression { none, gzip };
/// Order of accuracy of the time steps (kernels/README.md, "Second order in time"); automatic:
/// first.
enum class TimeOrder { automatic, first, second };

/// A body of fluid. `shape` decides which members are used; the loader refuses the others.
struct Body {
  Shape shape = Shape::block;
  Double3 min{}, max{};    ///< m, block (lattice of the spacing) and random_box
  Double3 center{};        ///< m, sphere (lattice points inside)
  double radius = 0;       ///< m, sphere, cylinder
  Double3 from{}, to{};    ///< m, cylinder: ends of the axis, along which the lattice lies
  std::int64_t count = 0;  ///< random_box: number of particles, uniform in the box
  std::uint64_t seed = 1;  ///< random_box: seed of the generator
  std::string path;        ///< file: CSV (header x,y,z[,vx,vy,vz]) or HDF5 (position[,velocity]);
                           ///< mesh: STL or OBJ; relative to the scene file
  Place place{};           ///< of the path
  Double3 velocity{};      ///< m/s, added to every particle of the body
  // mesh (lattice points inside): scaled, then turned about the origin, then moved
  double scale = 1;
  Double3 turn_axis{0, 0, 1};
  double turn_angle = 0;  ///< degrees, by the right-hand rule
  Double3 translate{};    ///< m
  bool operator==(const Body&) const = default;
  /// Whether its particles are known only when its file is read.
  bool from_file() const { return shape == Shape::file || shape == Shape::mesh; }
};

/// The faces of the domain in the order of WallBit's bits.
inline constexpr std::array<const char*, 6> kFaceNames = {"x_min", "x_max", "y_min",
                                                          "y_max", "z_min", "z_max"};

struct Domain {
  Double3 min{}, max{1, 1, 1};    ///< m
  std::vector<std::string> open;  ///< faces without a wall: x_min x_max y_min y_max z_min z_max
  bool loads = false;             ///< the fluid's forces on the walls are recorded
  std::vector<std::string> periodic{};     ///< axes whose two faces are joined: x y z
  double friction = 0;                     ///< of the walls, 0 (free slip) to 1 (no slip)
  std::vector<std::string> friction_on{};  ///< faces that have it; empty: all
  bool operator==(const Domain&) const = default;
  bool is_open(int axis, bool high) const {
    return std::find(open.begin(), open.end(), kFaceNames[std::size_t(2 * axis + high)]) !=
           open.end();
  }
  bool is_periodic(int axis) const {
    return std::find(periodic.begin(), periodic.end(), std::string(1, char('x' + axis))) !=
           periodic.end();
  }
  bool has_wall(int axis, bool high) const { return !is_open(axis, high) && !is_periodic(axis); }
  /// The friction of a face in the order of kFaceNames; 0 where there is no wall.
  double friction_of(int face) const {
    const bool on =
        friction_on.empty() || std::find(friction_on.begin(), friction_on.end(),
                                         kFaceNames[std::size_t(face)]) != friction_on.end();
    return on && has_wall(face / 2, face % 2 == 1) ? friction : 0;
  }
  /// Whether all six faces are walls.
  bool is_closed() const { return open.empty() && periodic.empty(); }
};

/// Smallest fluid.smoothing_ratio with fluid.mass: auto. Below it the density sum contains little
/// but the nearest neighbors, so close packing counts like the rest lattice, which has fewer but
/// farther ones: a pool sinks into that packing without compression (lib/program/calibrate.h).
constexpr double least_smoothing_ratio(int dimensions) { return dimensions == 2 ? 1.5 : 1.6; }

struct Fluid {
  double rest_density = 1000;  ///< kg/m^3, rho0
  double spacing = 0.02;       ///< m, d: lattice constant at rest
  double smoothing_ratio = 2;  ///< h/d
  std::optional<double> mass;  ///< kg per particle; absent: rho0 d^3 (rho0 d^2 times the thickness
                               ///< in two dimensions), density sum calibrated so that the rest
                               ///< lattice has density rho0; present: used as it is
  bool operator==(const Fluid&) const = default;
};

/// A step that adapts to the flow: lib/run/step_control.h.
struct AdaptiveTime {
  std::optional<double> step_min;  ///< s, lower bound of the step; absent: time.step/64
  double cfl = 0.4;                ///< fastest particle: v dt <= cfl h
  double force = 0.25;             ///< greatest acceleration: dt <= force sqrt(h/a)
  bool operator==(const AdaptiveTime&) const = default;
};

struct Time {
  double step = 0.002;                   ///< s, dt of one update; a number once the scene is loaded
  double end = 1;                        ///< s, rounded to whole updates
  std::optional<AdaptiveTime> adaptive;  ///< absent: an update is one step
  double motion_begin = 0;               ///< s, time of the motions when the run starts
  TimeOrder order = TimeOrder::automatic;
  bool operator==(const Time&) const = default;
};

struct SolverSettings {
  int iterations = 4;       ///< constraint iterations per substep; the minimum, with a tolerance
  double tolerance = 0;     ///< mean compression above which more iterations follow; 0: none
  int max_iterations = 32;  ///< maximum per substep, with a tolerance
  int substeps = 1;  ///< time steps of time.step/substeps that share one update's neighbor lists
  SolverMethod method = SolverMethod::jacobi;
  LevelsMode levels = LevelsMode::off;
  KernelMode kernels = KernelMode::consistent;
  ConstraintMode constraint = ConstraintMode::one_sided;
  double cfm = 1e-4;          ///< dimensionless eps^ = eps h^2 in lambda's denominator
  std::optional<double> sor;  ///< omega, factor on the position change of one iteration;
                              ///< absent: from h/d, see lib/program/plan.h
  BoundaryMode boundary = BoundaryMode::density;
  double wall_margin = 0;       ///< m, distance to a wall at which particles are clamped
  double velocity_damping = 1;  ///< factor on the velocity, once per update
  double speed_limit = 0;       ///< h per time.step, limit for particles; 0: none
  /// Rate of a viscosity of fourth order, sqrt(g/h); absent: lib/program/hyperviscosity.h
  std::optional<double> hyperviscosity;
  bool prestabilize = true;   ///< remove compression from the start, lib/run/prestabilize.h
  bool fused = true;          ///< density and lambda in one loop over the neighbors
  bool reproducible = false;  ///< cuda: the bits of the CPU, slower (kernels/README.md, "Bits")
  bool operator==(const SolverSettings&) const = default;
};

/// Artificial pressure (Macklin & Mueller 2013, eq. 13); s_corr = -k (W(r)/W(delta_q h))^n.
struct Tensile {
  double k = 1e-3;       ///< in units of h^2
  double delta_q = 0.3;  ///< in units of h
  int n = 4;             ///< exponent
  bool operator==(const Tensile&) const = default;
};

/// XSPH viscosity (Schechter & Bridson 2012; Macklin & Mueller 2013, eq. 17), symmetric. Its
/// strength is a share per update, or follows from a kinematic viscosity (lib/scene/viscosity.h).
struct Viscosity {
  double xsph = 0.05;                 ///< c, 0..1 stable; the loader makes it 0 beside `kinematic`
  std::optional<double> kinematic{};  ///< m^2/s, nu
  bool operator==(const Viscosity&) const = default;
};

/// Vorticity confinement (Macklin & Mueller 2013, eq. 15-16), bounded: kernels/README.md (13).
struct Vorticity {
  double epsilon = 0.1;  ///< 1/s
  bool operator==(const Vorticity&) const = default;
};

/// The fluid comes to rest before the run begins: lib/run/settle.h.
struct Settle {
  double duration = 2;             ///< s
  std::optional<Double3> gravity;  ///< m/s^2; absent: that of the run when it begins
  bool operator==(const Settle&) const = default;
};

/// Limits at which a run is stopped early; lib/run/guard.h describes them.
struct GuardSettings {
  std::optional<double> speed;   ///< m/s; absent: from the scene and the start
  std::optional<double> energy;  ///< growth, as a share of the energy at the start; absent: 0.1 and
                                 ///< energy that a start may release while it relaxes
  std::int64_t neighbors = 0;    ///< of one particle; 0: from the start
  bool operator==(const GuardSettings&) const = default;
};

struct Output {
  double every = 0.02;                 ///< s between frames, rounded to whole updates
  std::optional<double> gauges_every;  ///< s, the same for gauges; absent: as for measurements
  std::vector<std::string> fields{"velocity", "density"};  ///< besides position and id
  Precision precision = Precision::single;                 ///< of floating-point fields on disk
  Compression compression = Compression::none;             ///< gzip: shuffle + deflate 1
  bool operator==(const Output&) const = default;
};

/// Periodic checkpoints; a run that is stopped always writes one.
struct Checkpoint {
  double every = 60;  ///< s of wall time
  bool operator==(const Checkpoint&) const = default;
};

struct Camera {
  std::optional<Double3> position;  ///< m; absent: seen from outside the longest side
                                    ///< or, in two dimensions, straight at the plane
  std::optional<Double3> target;    ///< m; absent: center of the domain
  double fov = 35;                  ///< degrees, vertical
  double orbit = 0;                 ///< degrees per second of simulated time about `up`
  bool operator==(const Camera&) const = default;
};

/// A zone in which velocities decay as v/(1 + rate s^profile dt) (lib/scene/sponge.h).
struct Sponge {
  std::string name;
  Double3 min{}, max{};         ///< m
  std::string toward{"x_max"};  ///< a face: s grows from 0 to 1 towards that of the zone
  std::optional<double> rate;   ///< 1/s; absent: from the period of what makes waves
  int profile = 2;
  std::vector<std::string> axes{"x", "y", "z"};  ///< whose velocities decay
  bool operator==(const Sponge&) const = default;
};

struct Render {
  double every = 0.1;  ///< s between pictures, rounded to whole frames of `output`
  std::array<int, 2> size{1280, 720};
  RenderStyle style = RenderStyle::spheres;
  ColorBy color = ColorBy::speed;
  std::optional<std::array<double, 2>> range;  ///< of the color bar; absent: from the scene
  double radius = 0;  ///< m, drawn radius of a particle; 0: half the spacing
  Camera camera;
  bool operator==(const Render&) const = default;
};

struct Scene {
  std::string name = "scene";  ///< if no file gives one: lib/scene/scene_name.h
  int dimensions = 3;  ///< 2: the x-z plane in the middle of the domain's y, which is its thickness
  Domain domain;
  Fluid fluid;
  std::vector<Body> bodies;
  std::vector<Obstacle> obstacles;
  std::vector<Gauge> gauges;
  std::vector<Emitter> emitters;
  std::vector<Sink> sinks;
  std::vector<Comparison> compare;
  std::vector<Sponge> damping;
  Double3 gravity{0, 0, -9.81};  ///< m/s^2
  std::optional<TankMotion> tank_motion;
  std::optional<Settle> settle;
  Time time;
  SolverSettings solver;
  std::optional<Tensile> tensile;
  std::optional<Viscosity> viscosity;
  std::optional<Vorticity> vorticity;
  int measure_every = 10;   ///< updates between measurements
  double summary_from = 0;  ///< s, what a batch's summary says of gauges and loads begins there
  std::vector<std::string> summary;  ///< its columns of them (summary.h); empty: all
  std::optional<GuardSettings> guard = GuardSettings{};
  std::optional<Output> output;
  std::optional<Checkpoint> checkpoint;
  std::optional<Render> render;
  Backend backend = Backend::cpu;
  Precision precision = Precision::single;
  int threads = 0;  ///< CPU threads; 0: from the number of particles (lib/program/threads.h)
  /// Most particles at a time where their number changes; 0: all that emitters may bring
  /// (changes_rows() in lib/program/needs.h).
  std::int64_t capacity = 0;

  double h() const { return fluid.spacing * fluid.smoothing_ratio; }  ///< m, smoothing length
  /// y of the plane that holds all particles of a scene in two dimensions, m; empty in 3-D.
  std::optional<double> plane() const {
    if (dimensions != 2) return std::nullopt;
    return 0.5 * (domain.min[1] + domain.max[1]);
  }
  /// Origin of the coordinates used in a step (kernels/README.md, "Frame"), m.
  Double3 origin() const { return {domain.min[0], plane().value_or(domain.min[1]), domain.min[2]}; }
  /// Volume per particle of the rest lattice, m^3: d^3, in two dimensions d^2 times the thickness.
  double cell_volume() const {
    // Products, because the last bit of pow() differs between C libraries.
    if (dimensions == 3) return fluid.spacing * fluid.spacing * fluid.spacing;
    return fluid.spacing * fluid.spacing * (domain.max[1] - domain.min[1]);
  }
  /// Mass of one particle, kg.
  double particle_mass() const { return fluid.mass.value_or(fluid.rest_density * cell_volume()); }
  bool operator==(const Scene&) const = default;
};

}  // namespace pbf::scene_module
