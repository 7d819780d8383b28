#include "lib/scene/emit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/scene/lattice.h"
#include "lib/scene/number.h"
#include "lib/scene/particle_file.h"
#include "lib/scene/random.h"

namespace pbf {
namespace {

std::string resolved_path(const Body& body, const std::string& scene_dir) {
  const std::filesystem::path path(body.path);
  return path.is_absolute() ? body.path : (std::filesystem::path(scene_dir) / path).string();
}

void emit_block(const Body& body, double d, std::optional<double> plane,
                std::vector<Double3>& out) {
  const auto cells = block_cells(body, d, plane);
  const std::array<std::int64_t, 3> n{static_cast<std::int64_t>(cells[0]),
                                      static_cast<std::int64_t>(cells[1]),
                                      static_cast<std::int64_t>(cells[2])};
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        out.push_back({body.min[0] + (static_cast<double>(i) + 0.5) * d,
                       body.min[1] + (static_cast<double>(j) + 0.5) * d,
                       body.min[2] + (static_cast<double>(k) + 0.5) * d});
}

void emit_sphere(const Body& body, double d, std::optional<double> plane,
                 std::vector<Double3>& out) {
  const double limit = sphere_limit(body, d, plane);
  const std::int64_t n = half_width(limit), ny = plane ? 0 : n;
  for (std::int64_t k = -n; k <= n; ++k)
    for (std::int64_t j = -ny; j <= ny; ++j) {
      const auto w = half_width(limit - static_cast<double>(k * k) - static_cast<double>(j * j));
      for (std::int64_t i = -w; i <= w; ++i)
        out.push_back({body.center[0] + static_cast<double>(i) * d,
                       body.center[1] + static_cast<double>(j) * d,
                       body.center[2] + static_cast<double>(k) * d});
    }
}

void emit_random_box(const Body& body, bool flat, std::vector<Double3>& out) {
  SplitMix64 random(body.seed);
  for (std::int64_t i = 0; i < body.count; ++i) {
    Double3 x{};
    for (int a = 0; a < 3;
         a += flat ? 2 : 1)  // min(): rounding of the product may reach past the upper face
      x[a] = std::min(body.min[a] + random.uniform() * (body.max[a] - body.min[a]), body.max[a]);
    out.push_back(x);
  }
}

/// Refuses particles outside the domain. What lies outside by rounding only (a sphere that touches
/// a wall) is put on the wall. In two dimensions everything is put on the plane.
void hold_inside(const Scene& scene, std::size_t body, std::size_t first, std::vector<Double3>& x) {
  const Domain& domain = scene.domain;
  const std::optional<double> plane = scene.plane();
  for (std::size_t i = first; i < x.size(); ++i) {
    // Only a file has a y of its own.
    if (plane && scene.bodies[body].shape != Shape::file) x[i][1] = *plane;
    for (int a = 0; a < 3; ++a) {
      const double slack = 1e-9 * (domain.max[a] - domain.min[a]);
      if (!(x[i][a] >= domain.min[a] - slack && x[i][a] <= domain.max[a] + slack))
        throw Error(ExitCode::bad_input,
                    "bodies[" + std::to_string(body) + "]: particle " + std::to_string(i - first) +
                        " at " + to_text(x[i]) + " is outside the domain along " + "xyz"[a] + " (" +
                        to_text(domain.min[a]) + " .. " + to_text(domain.max[a]) + " m); " +
                        (plane && a == 1 ? "with dimensions: 2 that is the slab which holds all "
                                           "particles; give them such a y"
                                         : "move the body or enlarge the domain"));
      x[i][a] = std::clamp(x[i][a], domain.min[a], domain.max[a]);
    }
    if (plane) x[i][1] = *plane;
  }
}

/// In two dimensions nothing leaves the plane. A body's own velocity is checked with the scene.
void refuse_velocity_along_y(std::size_t body, const std::vector<Double3>& v) {
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i][1] != 0)
      throw Error(ExitCode::bad_input,
                  "bodies[" + std::to_string(body) + "]: particle " + std::to_string(i) +
                      " has velocity " + to_text(v[i]) +
                      "; with dimensions: 2 its y component must be 0: set it so in the file, or "
                      "give dimensions: 3");
}

}  // namespace

std::int64_t count_particles(const Scene& scene, const std::string& scene_dir) {
  double sum = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const double n = body.shape == Shape::file
                         ? static_cast<double>(count_particle_file(resolved_path(body, scene_dir)))
                         : lattice_count(body, scene.fluid.spacing, scene.plane());
    if (n < 1 && body.shape == Shape::file)
      throw Error(ExitCode::bad_input, "bodies[" + std::to_string(b) + "]: " +
                                           resolved_path(body, scene_dir) + ": holds no particles");
    sum += n;
  }
  if (sum < 1)
    throw Error(ExitCode::bad_input,
                "bodies: the scene has 0 particles; add a body or lower "
                "fluid.spacing");
  if (sum > kMaxParticles) throw Error(ExitCode::bad_input, "bodies: " + too_many_text(sum));
  return static_cast<std::int64_t>(sum);
}

Particles emit_particles(const Scene& scene, const std::string& scene_dir) {
  const auto total = static_cast<std::size_t>(count_particles(scene, scene_dir));
  Particles all;
  all.position.reserve(total);
  all.velocity.reserve(total);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const std::size_t first = all.size();
    switch (body.shape) {
      case Shape::block:
        emit_block(body, scene.fluid.spacing, scene.plane(), all.position);
        break;
      case Shape::sphere:
        emit_sphere(body, scene.fluid.spacing, scene.plane(), all.position);
        break;
      case Shape::random_box:
        emit_random_box(body, scene.dimensions == 2, all.position);
        break;
      case Shape::file: {
        const Particles p = read_particle_file(resolved_path(body, scene_dir));
        if (scene.dimensions == 2) refuse_velocity_along_y(b, p.velocity);
        all.position.insert(all.position.end(), p.position.begin(), p.position.end());
        all.velocity.insert(all.velocity.end(), p.velocity.begin(), p.velocity.end());
      }
    }
    all.velocity.resize(all.position.size(), Double3{});
    for (std::size_t i = first; i < all.size(); ++i)
      for (int a = 0; a < 3; ++a) all.velocity[i][a] += body.velocity[a];
    hold_inside(scene, b, first, all.position);
  }
  return all;
}

}  // namespace pbf
