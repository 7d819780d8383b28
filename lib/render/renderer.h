// Pictures of snapshots, rendered off screen. Nothing of OpenGL is linked: the GL library is opened
// when the first Renderer is made.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/base/worker.h"
#include "lib/render/mesh_surface.h"
#include "lib/scene/scene.h"
#include "lib/solver/snapshot.h"

namespace pbf::render_module {

/// 8-bit RGB, row-major, first row on top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// What a picture needs to know beside the particles.
struct View {
  std::string name;                    ///< of the scene, UTF-8
  Double3 domain_min{}, domain_max{};  ///< m, drawn as 12 lines
  /// m, corners of the part of it that the default camera shows whole; absent: all of it.
  std::optional<std::array<Double3, 2>> frame{};
  bool flat = false;     ///< a scene in two dimensions: seen along y by default
  Double3 up{0, 0, 1};   ///< against gravity
  double radius = 0.01;  ///< m, drawn radius of a particle
  RenderStyle style = RenderStyle::spheres;
  ColorBy color = ColorBy::speed;
  double rest_density = 1000;         ///< kg/m^3
  std::array<double, 2> range{0, 1};  ///< of the colour bar, in the unit of the field
  std::array<int, 2> size{1280, 720};
  Camera camera;
  std::vector<Solid<double>> solids{};  ///< obstacles: lengths in m, along the scene's axes
  /// Of those whose surface comes from a file, by their number: what is drawn of it.
  std::vector<std::shared_ptr<const std::vector<MeshTriangle>>> surfaces{};
  /// Where they are at a time, s, with these free bodies; empty: they stand.
  std::function<std::vector<Solid<double>>(double, const std::vector<BodyMotion>&)> solids_at{};
  std::array<std::array<bool, 2>, 3> open{};  ///< of each axis, min and max: no wall, solids go on
};

/// View of a scene: default camera, radius d/2, a frame and a colour range that hold for the whole
/// run (lib/render/reach.h; density: 0.9..1.1 rho0; compression: 0..1 %; id: 0..n-1).
View view_of(const Scene& scene, std::int64_t particles);

/// Draws the particles as lit spheres (impostors) or as one surface, obstacles, the box with
/// lengths along its floor and up one edge, a colour bar with unit, and the scene's name, time and
/// number of particles. Sky and ground light the scene from above and below; the sun casts one soft
/// shadow, but not in two dimensions.
class Renderer {
 public:
  /// Opens a GlContext (lib/render/gl_context.h), which says what `threads` are and what it throws.
  /// Throws Error(bad_input) also for a view that cannot be drawn.
  explicit Renderer(const View& view, int threads = 0);
  ~Renderer();
  /// From any thread, one at a time. Particles with a non-finite position are left out, those with
  /// a non-finite value are magenta.
  /// Error(bad_input) when the snapshot lacks the field that `color` needs.
  Image draw(const Snapshot& snapshot);
  std::string backend() const;  ///< e.g. "OSMesa llvmpipe"

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// PNG; an OutputFile. Throws Error(io).
void write_png(const std::string& path, const Image& image);

/// Draws on a thread of its own and writes DIR/frame_000123.png (number = index of the picture).
/// The end draws what is queued; an error that finish() would have thrown is lost.
/// A software rasteriser draws on that thread too and starts none of its own, so that a CPU solver
/// beside it is not stalled (LP_NUM_THREADS in the environment wins).
class RenderThread {
 public:
  /// Opens the GL library: throws Error(unavailable) at once. Before the first picture: into().
  explicit RenderThread(const View& view);
  /// Makes the folder of the pictures. Throws Error(io).
  void into(const std::string& dir);
  /// Queues a copy of the fields that the picture needs; blocks while 2 wait. An error of the
  /// thread is thrown by the next draw() or by finish(), once; later pictures are dropped.
  void draw(const Snapshot& snapshot, std::int64_t index);
  void wait();    ///< until all queued pictures are written; throws as draw() does
  void finish();  ///< waits until all queued pictures are written
  double seconds() const { return seconds_; }  ///< spent drawing and writing

 private:
  void rethrow();

  const ColorBy color_;
  Renderer renderer_;  // opened by the caller's thread, so that its errors come at once
  std::string dir_;
  std::atomic<double> seconds_ = 0;
  bool told_ = false;  // of an error
  Worker worker_;      // last: its jobs use the rest
};

}  // namespace pbf::render_module
