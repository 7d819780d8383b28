// What is likely to be nonsense, though it is no error: told before a run, during it, at its end.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/measures.h"
#include "lib/solver/snapshot.h"

namespace pbf::inline run_module {

/// `kind`: step, speed, overlap, crowded, output (of a scene); compressed, passed_through, left (of
/// a run). At most one of each kind in a list.
struct Warning {
  std::string kind, text;
};

/// Mean compression from which on a fluid is not a liquid, 1.
constexpr double kNoLiquid = 0.05;

/// Mean compression of the scene's fluid at rest in its box, as time.step and the iterations leave
/// it: 2/3 (g dt^2/h) (H/h) / iterations, with dt of a substep and the depth H of the fluid spread
/// over the box's floor. Within a factor of 2 for pools of 6 to 48 layers (lib/solver/
/// DIAGNOSTICS.md, "Compression at rest"). 0: no gravity, no floor, no iterations.
double compression_at_rest(const Scene& scene, std::int64_t particles);

/// Of a scene, before anything is run. `particles`: of count_particles(). Takes time in proportion
/// to the particles that may overlap. Throws as emit_particles() for a file that cannot be read.
std::vector<Warning> scene_warnings(const Scene& scene, const std::string& scene_dir,
                                    std::int64_t particles);

/// Of a run that goes on. Hand it every measure that is due, in order.
class RunWarnings {
 public:
  /// updates: of the whole run. The scene must outlive this.
  RunWarnings(const Scene& scene, std::int64_t particles, std::int64_t updates)
      : scene_(&scene), particles_(particles), updates_(updates) {}
  /// Before the first measure of a run that goes on: its compressed_updates() so far.
  void go_on_from(std::int64_t compressed) { compressed_ = compressed; }
  void follow(const Measures& due);
  /// Counts the particles beyond open faces: rows of 3 numbers, in m.
  void look_outside(const Snapshot& snapshot);
  /// The same of Solver::positions(), in h from Scene::origin().
  void look_outside(const std::vector<double>& positions);
  /// What there is to say at a measure; `end`: the run's last one.
  std::vector<Warning> at(const Measures& m, bool end) const;
  /// Updates so far whose next measure found a mean compression above kNoLiquid.
  std::int64_t compressed_updates() const { return compressed_; }

 private:
  template <class Coordinate>
  void count_outside(std::size_t n, const Coordinate& coordinate);

  const Scene* scene_;
  std::int64_t particles_, updates_, compressed_ = 0;
  std::int64_t left_ = 0;
  double farthest_ = 0;  ///< m
  std::string faces_;    ///< through which they left
};

}  // namespace pbf::inline run_module
