#include "lib/render/fluid_surface.h"

#include <array>

#include "lib/render/colormap.h"
#include "lib/render/particles.h"
#include "lib/scene/vector3.h"
#include "pbf_shaders.h"

namespace pbf::render_module {
namespace {

using Depth = gl::Target::Depth;

/// The colours of the shares that particles have; the last is for those without a value.
std::array<std::array<std::uint8_t, 4>, kNoShare + 1> bar_of(ColorBy color) {
  std::array<std::array<std::uint8_t, 4>, kNoShare + 1> bar{};
  for (std::size_t i = 0; i < bar.size(); ++i) {
    const Rgb c =
        i == kNoShare ? kNoValue : color_map(color)(static_cast<double>(i) / (kNoShare - 1));
    bar[i] = {c[0], c[1], c[2], 255};
  }
  return bar;
}

}  // namespace

FluidSurface::FluidSurface(const gl::Table& gl, const View& view, int factor)
    : gl_(gl),
      size_(view.size),
      factor_(factor),
      flat_(view.flat),
      low_(view.domain_min),
      high_(view.domain_max),
      radius_(drawn_radius(view)),
      depth_program_(gl, shaders::sphere_vertex, shaders::surface_depth_fragment, shaders::within),
      thickness_program_(gl, shaders::sphere_vertex, shaders::thickness_fragment, shaders::within),
      smooth_program_(gl, shaders::resolve_vertex, shaders::smooth_fragment),
      water_program_(gl, shaders::resolve_vertex, shaders::water_fragment, shaders::shadowed),
      nothing_(gl, 4, {}, 0),
      bar_(gl, kNoShare + 1, 1, gl::kColor8, bar_of(view.color).data()),
      depth_(gl, size_[0], size_[1], gl::kPair32, Depth::with),
      between_(gl, size_[0], size_[1], gl::kPair32, Depth::without),
      thickness_(gl, size_[0], size_[1], gl::kSums16, Depth::without),
      scene_(gl, size_[0], size_[1], gl::kColor8, Depth::without) {
  const double far = 1e6 * length(high_ - low_);
  for (std::size_t k = 0; k < 3; ++k) {
    if (view.open[k][0]) low_[k] -= far;
    if (view.open[k][1]) high_[k] += far;
  }
}

/// For the spheres.
void FluidSurface::use(const Lens& lens, const gl::Program& program) const {
  constexpr std::array<const char*, 3> kNames{"u_axis_x", "u_axis_y", "u_axis_z"};
  lens.use(program, 1);
  program.set("u_radius", radius_);
  const Double3 eye = lens.projection.eye;
  for (std::size_t k = 0; k < 3; ++k) {
    Double3 axis{};
    axis[k] = 1;
    program.set(kNames[k], lens.projection.direction(axis));
  }
  program.set("u_low", low_ - eye);
  program.set("u_high", high_ - eye);
}

void FluidSurface::draw_depth(const Lens& lens) {
  depth_.draw_into();
  gl_.Enable(gl::DEPTH_TEST);
  gl_.Clear(gl::COLOR_BUFFER_BIT | gl::DEPTH_BUFFER_BIT);
  use(lens, depth_program_);
  gl_.DrawArraysInstanced(gl::TRIANGLE_STRIP, 0, 4, visible_);
  gl_.Disable(gl::DEPTH_TEST);
}

void FluidSurface::draw_thickness(const Lens& lens, const gl::Texture& stored) {
  thickness_.draw_into();
  gl_.Clear(gl::COLOR_BUFFER_BIT);
  gl_.Enable(gl::BLEND);
  gl_.BlendFunc(gl::ONE, gl::ONE);
  use(lens, thickness_program_);
  thickness_program_.set_int("u_factor", factor_);
  stored.bind(thickness_program_, "u_stored", 0);
  gl_.DrawArraysInstanced(gl::TRIANGLE_STRIP, 0, 4, visible_);
  gl_.Disable(gl::BLEND);
}

void FluidSurface::smooth(const Lens& lens) {
  nothing_.bind();
  // Narrow first, for what the wide one would step over; narrow last, for what it has left of that.
  for (const double width : {1.0, 4.0, 1.5})
    for (const bool upright : {false, true}) {
      (upright ? depth_ : between_).draw_into();
      lens.use(smooth_program_, 1);
      (upright ? between_ : depth_).color().bind(smooth_program_, "u_surface", 0);
      smooth_program_.set("u_along", upright ? 0 : 1, upright ? 1 : 0);
      smooth_program_.set("u_width", width * radius_, radius_);
      gl_.DrawArrays(gl::TRIANGLES, 0, 3);
    }
}

void FluidSurface::draw(const Lens& lens, const gl::Buffer& particles, std::size_t visible,
                        const gl::Texture& stored, const ShadowMap* shadow,
                        const gl::Target& picture) {
  visible_ = static_cast<gl::Size>(visible);
  particles.bind();
  draw_depth(lens);
  draw_thickness(lens, stored);
  smooth(lens);

  picture.draw_into();
  lens.use(water_program_, 1);
  depth_.color().bind(water_program_, "u_surface", 0);
  thickness_.color().bind(water_program_, "u_thickness", 1);
  scene_.color().bind(water_program_, "u_scene", 2);
  stored.bind(water_program_, "u_stored", 3);
  bar_.bind(water_program_, "u_bar", 4);
  ShadowMap::use(shadow, lens, water_program_, 5);
  water_program_.set_int("u_factor", factor_);
  water_program_.set("u_size", size_[0], size_[1]);
  water_program_.set("u_radius", radius_);
  // Water of a plane is looked at along its thickness, which says nothing.
  water_program_.set("u_clear", 3 * radius_, flat_ ? 0 : 0.4);
  gl_.DrawArrays(gl::TRIANGLES, 0, 3);
}

}  // namespace pbf::render_module
