// The fluid as one surface, found in the picture: the depth of the particles, smoothed.
#pragma once

#include <cstddef>

#include "lib/render/light.h"

namespace pbf::render_module {

/// Made and destroyed while its context is current.
/// Method: W. van der Laan, S. Green, M. Sainz, "Screen space fluid rendering with curvature flow",
/// I3D 2009; the depth is smoothed by pairs of pixels on both sides, which leaves planes as they
/// are, in place of curvature flow.
class FluidSurface {
 public:
  /// `factor`: samples per pixel and direction of the scene's depth.
  FluidSurface(const gl::Table& gl, const View& view, int factor);

  /// What the scene without the fluid is to be drawn into first.
  const gl::Target& scene() const { return scene_; }
  /// Draws `scene()` with the fluid in it into `picture`. `visible` instances of `particles`;
  /// `stored`: depth of the scene; `shadow`: null for none.
  void draw(const Lens& lens, const gl::Buffer& particles, std::size_t visible,
            const gl::Texture& stored, const ShadowMap* shadow, const gl::Target& picture);

 private:
  void use(const Lens& lens, const gl::Program& program) const;
  void draw_depth(const Lens& lens);
  void draw_thickness(const Lens& lens, const gl::Texture& stored);
  void smooth(const Lens& lens);

  const gl::Table& gl_;
  std::array<int, 2> size_;
  int factor_;
  bool flat_;
  Double3 low_, high_;  ///< m, of the domain; far away where a wall is open
  double radius_;       ///< of the spheres drawn, m
  gl::Size visible_ = 0;
  gl::Program depth_program_, thickness_program_, smooth_program_, water_program_;
  gl::Buffer nothing_;
  gl::Texture bar_;
  gl::Target depth_, between_, thickness_, scene_;
};

}  // namespace pbf::render_module
