// The light of a picture, and what every program is told of light and camera.
#pragma once

#include "lib/render/camera.h"
#include "lib/render/gl_objects.h"

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

}  // namespace pbf::render_module
