#include "lib/render/renderer.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "lib/base/error.h"
#include "lib/render/box.h"
#include "lib/render/camera.h"
#include "lib/render/fluid_surface.h"
#include "lib/render/gl_context.h"
#include "lib/render/gl_objects.h"
#include "lib/render/grid.h"
#include "lib/render/light.h"
#include "lib/render/overlay.h"
#include "lib/render/particles.h"
#include "lib/render/solids.h"
#include "lib/scene/vector3.h"
#include "pbf_shaders.h"

namespace pbf::render_module {
namespace {

/// What a shadow takes away of the floor's light, which is drawn as fully lit.
constexpr double kFloorInShadow = 0.3;

void check_view(const View& view) {
  if (view.size[0] < 16 || view.size[1] < 16)
    bad_input("render.size", fmt::format("{} x {} is too small; give at least 16 x 16 pixels",
                                         view.size[0], view.size[1]));
  if (!(view.range[0] < view.range[1]) || !std::isfinite(view.range[1] - view.range[0]))
    bad_input("render.range", fmt::format("{:f} to {:f} is not a range; give two finite numbers, "
                                          "the smaller one first",
                                          view.range[0], view.range[1]));
  if (!(view.radius > 0) || !std::isfinite(view.radius))
    bad_input("render.radius",
              fmt::format("{:f} is not a radius; give a length above 0", view.radius));
  projection_of(view, 0);  // throws for a camera that cannot look
}

/// 2 x 2 samples per pixel; 1 where that is more than the driver can hold.
int samples_per_edge(const gl::Table& gl, std::array<int, 2> size) {
  gl::Int texture = 0;
  std::array<gl::Int, 2> viewport{};
  gl.GetIntegerv(gl::MAX_TEXTURE_SIZE, &texture);
  gl.GetIntegerv(gl::MAX_VIEWPORT_DIMS, viewport.data());
  const int wide = std::min(texture, viewport[0]), high = std::min(texture, viewport[1]);
  if (size[0] > wide || size[1] > high)
    bad_input("render.size",
              fmt::format("{} x {} is more than the {} x {} pixels of this OpenGL driver", size[0],
                          size[1], wide, high));
  return 2 * size[0] <= wide && 2 * size[1] <= high ? 2 : 1;
}

}  // namespace

/// Everything that lives inside a context; destroyed while the context is current.
struct Pipeline {
  const gl::Table& gl;
  int factor;
  Light light;
  gl::Program spheres, solids, flat, resolve;
  gl::Buffer particle_buffer, solid_buffer, flat_buffer, nothing;
  gl::Target samples, picture;
  std::optional<ShadowMap> shadow;      // but not in two dimensions
  std::optional<FluidSurface> surface;  // where the style asks for it

  Pipeline(const gl::Table& table, const View& view)
      : gl(table),
        factor(samples_per_edge(table, view.size)),
        light(light_of(view)),
        spheres(table, shaders::sphere_vertex, shaders::sphere_fragment),
        solids(table, shaders::solid_vertex, shaders::solid_fragment),
        flat(table, shaders::flat_vertex, shaders::flat_fragment),
        resolve(table, shaders::resolve_vertex, shaders::resolve_fragment, shaders::shadowed),
        particle_buffer(table, sizeof(ParticleVertex),
                        {{3, gl::FLOAT, 0, offsetof(ParticleVertex, place)},
                         {4, gl::UNSIGNED_BYTE, 1, offsetof(ParticleVertex, color)}},
                        1),
        solid_buffer(table, sizeof(SolidVertex),
                     {{3, gl::FLOAT, 0, offsetof(SolidVertex, place)},
                      {3, gl::FLOAT, 0, offsetof(SolidVertex, normal)}},
                     0),
        flat_buffer(table, sizeof(FlatVertex),
                    {{3, gl::FLOAT, 0, offsetof(FlatVertex, place)},
                     {3, gl::UNSIGNED_BYTE, 1, offsetof(FlatVertex, color)}},
                    0),
        nothing(table, 4, {}, 0),
        samples(table, factor * view.size[0], factor * view.size[1], gl::kColor8,
                gl::Target::Depth::with),
        picture(table, view.size[0], view.size[1], gl::kColor8, gl::Target::Depth::without) {
    if (!view.flat) shadow.emplace(table, view, light);
    if (view.style == RenderStyle::surface) surface.emplace(table, view, factor);
  }
};

struct Renderer::Impl {
  View view;
  GlContext context;
  std::unique_ptr<Pipeline> pipeline;
  ParticleVertices particles;
  std::vector<FlatVertex> triangles;
  std::vector<std::uint8_t> pixels;

  Impl(const View& v, int threads) : view((check_view(v), v)), context(threads) {
    const GlCurrent current(context);
    pipeline = std::make_unique<Pipeline>(context.gl(), view);
  }
  ~Impl() {
    const GlCurrent current(context);
    pipeline.reset();
  }

  void draw_scene(const Projection& projection);
  Image read_back();
};

void Renderer::Impl::draw_scene(const Projection& projection) {
  const gl::Table& gl = context.gl();
  Pipeline& p = *pipeline;
  // As narrow a range of depths as the particles and the box leave: it decides the resolution.
  const double diagonal = length(view.domain_max - view.domain_min);
  double near = particles.nearest, far = particles.farthest;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const double depth = projection.to_view(corner_of(view, corner))[2];
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  const SolidSurfaces solids = surfaces_of(view, projection, p.light.sun);
  for (const SolidVertex& v : solids.triangles) {
    near = std::min<double>(near, v.place[2]);
    far = std::max<double>(far, v.place[2]);
  }
  near = std::max(0.99 * near, 1e-3 * diagonal);
  far = std::max(1.01 * far, 2 * near) + 0.01 * diagonal;
  const double a = far / (far - near), b = a * near;

  const double line = std::max(1.0, view.size[1] / 720.0);  // pixels
  const Lens lens{projection, p.light, a, b};
  const ShadowMap* shadow = p.shadow ? &*p.shadow : nullptr;
  p.particle_buffer.bind();
  p.particle_buffer.fill(particles.list.data(), particles.list.size() * sizeof(ParticleVertex));
  if (shadow)
    p.shadow->draw(lens, p.particle_buffer, particles.list.size(), view.radius, solids.casters);

  p.samples.draw_into();
  gl.Enable(gl::DEPTH_TEST);
  gl.DepthFunc(gl::LEQUAL);
  gl.Clear(gl::COLOR_BUFFER_BIT | gl::DEPTH_BUFFER_BIT);
  lens.use(p.solids, p.factor);
  p.solids.set("u_color", (1 / 255.0) * kClay);
  p.solid_buffer.draw_triangles(solids.triangles);
  lens.use(p.flat, p.factor);
  p.flat.set("u_share", kFloorInShadow);
  triangles.clear();
  add_floor(view, projection, triangles);
  add_floor_grid(view, projection, line, near, triangles);
  p.flat_buffer.draw_triangles(triangles);
  p.flat.set("u_share", 0);
  triangles.clear();
  for (const auto& [from, to] : solids.creases)
    add_line(from, to, kCrease, projection, 1.2 * line, near, triangles);
  add_box_edges(view, projection, 1.6 * line, near, triangles);
  p.flat_buffer.draw_triangles(triangles);
  const bool as_spheres = particles.visible > 0 && !p.surface;
  if (as_spheres) {
    lens.use(p.spheres, p.factor);
    p.spheres.set("u_radius", view.radius);
    p.particle_buffer.bind();
    gl.DrawArraysInstanced(gl::TRIANGLE_STRIP, 0, 4, static_cast<gl::Size>(particles.visible));
  }

  (p.surface ? p.surface->scene() : p.picture).draw_into();
  gl.Disable(gl::DEPTH_TEST);
  lens.use(p.resolve, p.factor);
  p.resolve.set_int("u_factor", p.factor);
  p.resolve.set("u_size", view.size[0], view.size[1]);
  p.resolve.set("u_radius", view.radius);
  p.samples.color().bind(p.resolve, "u_color", 0);
  p.samples.depth().bind(p.resolve, "u_stored", 1);
  ShadowMap::use(shadow, lens, p.resolve, 2);
  p.nothing.bind();
  gl.DrawArrays(gl::TRIANGLES, 0, 3);
  if (p.surface)
    p.surface->draw(lens, p.particle_buffer, particles.visible, p.samples.depth(), shadow,
                    p.picture);
}

Image Renderer::Impl::read_back() {
  const gl::Table& gl = context.gl();
  const auto width = static_cast<std::size_t>(view.size[0]);
  const auto height = static_cast<std::size_t>(view.size[1]);
  pixels.resize(4 * width * height);
  gl.PixelStorei(gl::PACK_ALIGNMENT, 1);
  gl.ReadPixels(0, 0, view.size[0], view.size[1], gl::RGBA, gl::UNSIGNED_BYTE, pixels.data());
  if (const gl::Enum error = gl.GetError(); error != gl::NO_ERROR)
    throw Error(ExitCode::unavailable,
                error == gl::OUT_OF_MEMORY
                    ? "the OpenGL driver ran out of memory; choose a smaller render.size"
                    : "OpenGL error " + std::to_string(error) + " while drawing");
  Image image{view.size[0], view.size[1], std::vector<std::uint8_t>(3 * width * height)};
  auto* to = image.rgb.data();
  for (std::size_t y = height; y-- > 0;) {  // OpenGL's first row is the lowest
    const auto* from = &pixels[4 * width * y];
    for (std::size_t x = 0; x < width; ++x, from += 4) to = std::copy(from, from + 3, to);
  }
  return image;
}

Renderer::Renderer(const View& view, int threads) : impl_(std::make_unique<Impl>(view, threads)) {}

Renderer::~Renderer() = default;

Image Renderer::draw(const Snapshot& snapshot) {
  View& view = impl_->view;
  if (view.solids_at) view.solids = view.solids_at(snapshot.time, snapshot.bodies);
  const Projection projection = projection_of(view, snapshot.time);
  collect(snapshot, view, projection, impl_->particles);
  Image image;
  {
    const GlCurrent current(impl_->context);
    impl_->draw_scene(projection);
    image = impl_->read_back();
  }
  const std::string& unit = snapshot.find(about(view.color).field)->unit;
  const bool relative = view.color == ColorBy::compression || unit == "1";
  draw_overlay(image, view, projection, relative ? "" : unit,
               static_cast<std::int64_t>(snapshot.count), snapshot.time);
  return image;
}

std::string Renderer::backend() const { return impl_->context.backend(); }

}  // namespace pbf::render_module
