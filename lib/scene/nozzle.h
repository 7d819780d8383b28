// The geometry of an emitter: its columns of particles, and its casing (kernels/README.md,
// "Emitters and sinks").
#pragma once

#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {

/// Most layers of an emitter that begin to wait in one update: with those that wait, at most
/// kPipeLayers (kernels/emission.h).
inline constexpr int kMostLayersPerUpdate = 4;

/// Layers that always wait behind the opening: as many as a particle in it can see.
int held_layers(const Scene& scene);

/// A casing with a bore, in which layers of particles wait. The casing is so thick that nothing
/// outside sees where layers begin.
struct NozzlePlace {
  Double3 center{}, normal{};   ///< m; unit vector
  Double3 side[2]{};            ///< unit vectors in the plane of the opening
  double half[2]{};             ///< m, half the edges of the opening; of a disc the radius, twice
  bool disc = false;            ///< round; in two dimensions nothing is
  double depth = 0, wall = 0;   ///< m, of the bore; thickness of the casing
  std::vector<Double3> column;  ///< m, where each column goes through the opening

  double length() const { return depth + wall; }  ///< m, of the casing
  /// Whether a place is in the casing, enlarged by `margin` (m).
  bool holds(const Double3& x, double margin) const;
  /// The eight corners of the bore, or of the box about it.
  std::vector<Double3> corners() const;
  /// Places on and in the casing, at most `apart` from each other (m).
  std::vector<Double3> places(double apart) const;
  /// Where the first layers wait, m.
  std::vector<Double3> held(double spacing, int layers) const;
};
/// In two dimensions the opening is a line in the plane of the particles.
NozzlePlace nozzle_place(const Scene& scene, const Emitter& emitter);

/// m/s, the highest speed between start and end. 0 if the file was not read.
double fastest_of(const Emitter& emitter);
/// m/s, of all emitters that are on between two times, at most.
double fastest_emitter(const Scene& scene, double from, double to);

}  // namespace pbf::scene_module
