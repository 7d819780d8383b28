#include "lib/render/light.h"

#include "lib/scene/vector3.h"

namespace pbf::render_module {

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

}  // namespace pbf::render_module
