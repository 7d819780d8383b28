#include "lib/render/light.h"

#include <algorithm>
#include <cmath>

#include "lib/scene/vector3.h"
#include "pbf_shaders.h"

namespace pbf::render_module {
namespace {

constexpr double kSoft = 3;  // texels from the middle of a penumbra to its edge

}  // namespace

Light light_of(const View& view) {
  const Projection camera = projection_of(view, 0);
  const Double3 sky = unit(view.up), right = camera.right;  // a level direction
  const Double3 away = unit(cross(sky, right));
  return {sky, unit(sky - 0.5 * right - 0.6 * away)};
}

void Lens::use(const gl::Program& program, int samples) const {
  const Projection& p = projection;
  program.use();
  program.set("u_lens", {1 / (p.tan_half * p.aspect()), 1 / p.tan_half, p.shift[0]}, p.shift[1]);
  program.set("u_sky", p.direction(light.sky));
  program.set("u_sun", p.direction(light.sun));
  program.set("u_step", p.pixel() / samples);
  program.set("u_depth", depth_a, depth_b);
}

ShadowMap::ShadowMap(const gl::Table& gl, const View& view, const Light& light)
    : gl_(gl),
      middle_(0.5 * (view.domain_min + view.domain_max)),
      axes_([&] {
        const Double3 away = -1.0 * light.sun;
        const Double3 across = unit(cross(away, light.sky)), along = cross(across, away);
        std::array<Axis, 3> axes{Axis{across, 0}, {along, 0}, {away, 0}};
        for (Axis& axis : axes) {
          for (unsigned corner = 0; corner < 8; ++corner)
            axis.size = std::max(
                axis.size, 2.02 * std::abs(dot(corner_of(view, corner) - middle_, axis.unit)));
          axis.size += 4 * view.radius;  // spheres at the walls
        }
        return axes;
      }()),
      texels_(texels(axes_)),
      spheres_(gl, shaders::shadow_sphere_vertex, shaders::shadow_sphere_fragment),
      solids_(gl, shaders::shadow_solid_vertex, shaders::shadow_solid_fragment),
      buffer_(gl, sizeof(SolidVertex), {{3, gl::FLOAT, 0, offsetof(SolidVertex, place)}}, 0),
      target_(gl, texels_[0], texels_[1], gl::kColor8, gl::Target::Depth::alone) {
  target_.depth().compare_linearly();
}

std::array<int, 2> ShadowMap::texels(const std::array<Axis, 3>& axes) {
  const double longer = std::max(axes[0].size, axes[1].size);
  const auto count = [&](const Axis& axis) {
    return std::max(8, static_cast<int>(std::ceil(kShadowTexels * axis.size / longer)));
  };
  return {count(axes[0]), count(axes[1])};
}

/// From view space to places on the map, each coordinate and the depth from 0 to 1.
void ShadowMap::set_rows(const Lens& lens, const gl::Program& program) const {
  constexpr std::array<const char*, 3> kNames{"u_map_x", "u_map_y", "u_map_z"};
  const Double3 eye = lens.projection.eye - middle_;
  for (std::size_t k = 0; k < 3; ++k) {
    const Axis& axis = axes_[k];
    program.set(kNames[k], (1 / axis.size) * lens.projection.direction(axis.unit),
                dot(eye, axis.unit) / axis.size + 0.5);
  }
}

void ShadowMap::draw(const Lens& lens, const gl::Buffer& particles, std::size_t count,
                     double radius, const std::vector<SolidVertex>& casters) {
  target_.draw_into();
  gl_.Enable(gl::DEPTH_TEST);
  gl_.DepthFunc(gl::LEQUAL);
  gl_.Clear(gl::DEPTH_BUFFER_BIT);
  if (!casters.empty()) {
    solids_.use();
    set_rows(lens, solids_);
    buffer_.draw_triangles(casters);
  }
  if (count == 0) return;
  spheres_.use();
  set_rows(lens, spheres_);
  // Never below a texel: a drop casts a shadow too.
  const auto half = [&](std::size_t k) {
    return std::max(radius / axes_[k].size, 0.7 / texels_[k]);
  };
  spheres_.set("u_ball", {half(0), half(1), radius / axes_[2].size});
  particles.bind();
  gl_.DrawArraysInstanced(gl::TRIANGLE_STRIP, 0, 4, static_cast<gl::Size>(count));
}

void ShadowMap::use(const ShadowMap* map, const Lens& lens, const gl::Program& program,
                    gl::Uint unit) {
  // A unit of its own in any case: samplers of two kinds must not share one.
  program.set_int("u_shadow", static_cast<gl::Int>(unit));
  program.set("u_soft", {0, 0, 0}, 0);
  if (!map) return;
  map->set_rows(lens, program);
  map->target_.depth().bind(program, "u_shadow", unit);
  const auto& a = map->axes_;
  const double reach = kSoft * std::max(a[0].size / map->texels_[0], a[1].size / map->texels_[1]);
  program.set("u_soft", {reach / a[0].size, reach / a[1].size, reach / a[2].size}, 1);
}

}  // namespace pbf::render_module
