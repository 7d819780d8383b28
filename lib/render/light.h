// The light of a picture with its shadows, and what every program is told of light and camera.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lib/render/camera.h"
#include "lib/render/gl_objects.h"
#include "lib/render/solids.h"

namespace pbf::render_module {

/// Unit vectors along the scene's axes. The sky is above, the ground below; the sun is one
/// direction, from which shadows fall.
struct Light {
  Double3 sky{0, 0, 1}, sun{0, 0, 1};
};

/// The sun stands over the left shoulder of the camera at time 0, so that a camera in orbit goes
/// round a scene whose shadows stay.
Light light_of(const View& view);

/// Stored depth = depth_a - depth_b / z.
struct Lens {
  const Projection& projection;
  Light light;
  double depth_a, depth_b;

  /// Uses `program` and sets the uniforms that stand in front of every shader. `samples`: per pixel
  /// and direction of the picture it draws.
  void use(const gl::Program& program, int samples) const;
};

/// What the sun sees: the map from which soft shadows are read. Made and destroyed while its
/// context is current. Its texels cover the domain, so that they stay where they are from picture
/// to picture; what is outside of it casts no shadow.
class ShadowMap {
 public:
  ShadowMap(const gl::Table& gl, const View& view, const Light& light);
  /// Draws the particles (`count` instances of `particles`, `radius` in m) and the faces away from
  /// the sun (`casters`, three corners each).
  void draw(const Lens& lens, const gl::Buffer& particles, std::size_t count, double radius,
            const std::vector<SolidVertex>& casters);
  /// Sets what shadowed.glsl reads; `program` is in use. Without a `map` nothing is in shadow.
  static void use(const ShadowMap* map, const Lens& lens, const gl::Program& program,
                  gl::Uint unit);

 private:
  /// An axis of the map: along it, a place is `unit` . (x - middle) / size + 1/2.
  struct Axis {
    Double3 unit;
    double size;
  };
  void set_rows(const Lens& lens, const gl::Program& program) const;
  static std::array<int, 2> texels(const std::array<Axis, 3>& axes);

  const gl::Table& gl_;
  Double3 middle_;
  std::array<Axis, 3> axes_;
  std::array<int, 2> texels_;
  gl::Program spheres_, solids_;
  gl::Buffer buffer_;
  gl::Target target_;
};

}  // namespace pbf::render_module
