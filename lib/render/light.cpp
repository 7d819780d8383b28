#include "lib/render/light.h"

#include "lib/scene/vector3.h"

namespace pbf::inline render_module {

Light light_of(const View& view) {
  const Projection camera = projection_of(view, 0);
  const Double3 sky = unit(view.up), right = camera.right;  // a level direction
  const Double3 away = unit(cross(sky, right));
  return {sky, unit(sky - 0.5 * right - 0.6 * away)};
}

Double3 Lens::seen(const Double3& d) const {
  return {dot(d, projection.right), dot(d, projection.up), dot(d, projection.forward)};
}

void Lens::use(const gl::Table& gl, const gl::Program& program, int samples) const {
  const Projection& p = projection;
  program.use();
  const double aspect = static_cast<double>(p.size[0]) / p.size[1];
  set_uniform(gl, program, "u_lens", {1 / (p.tan_half * aspect), 1 / p.tan_half, p.shift[0]},
              p.shift[1]);
  set_uniform(gl, program, "u_sky", seen(light.sky));
  set_uniform(gl, program, "u_sun", seen(light.sun));
  gl.Uniform1f(program.uniform("u_step"), static_cast<float>(p.pixel() / samples));
  gl.Uniform2f(program.uniform("u_depth"), static_cast<float>(depth_a),
               static_cast<float>(depth_b));
}

void set_uniform(const gl::Table& gl, const gl::Program& program, const char* name,
                 const Double3& xyz, double w) {
  gl.Uniform4f(program.uniform(name), static_cast<float>(xyz[0]), static_cast<float>(xyz[1]),
               static_cast<float>(xyz[2]), static_cast<float>(w));
}

}  // namespace pbf::inline render_module
