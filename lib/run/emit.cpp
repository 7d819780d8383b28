#include "lib/run/emit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/io/particle_file.h"
#include "lib/program/obstacles.h"
#include "lib/run/motion_files.h"
#include "lib/scene/number.h"

namespace pbf::run_module {
namespace {

/// "scene.yaml:4:30: bodies[0]", for messages about the particles of this body.
std::string name_of(const Scene& scene, std::size_t body) {
  const std::string& place = scene.bodies[body].place.text;
  return (place.empty() ? "" : place + ": ") + "bodies[" + std::to_string(body) + "]";
}

/// Refuses particles outside the domain. A particle that is outside only by rounding (a sphere that
/// touches a wall) is put on the wall. In two dimensions every particle is put on the plane.
void hold_inside(const Scene& scene, std::size_t body, std::size_t first, std::vector<Double3>& x) {
  const Domain& domain = scene.domain;
  const std::optional<double> plane = scene.plane();
  for (std::size_t i = first; i < x.size(); ++i) {
    // Only particles from a file have a y of their own.
    if (plane && scene.bodies[body].shape != Shape::file) x[i][1] = *plane;
    for (int a = 0; a < 3; ++a) {
      const double slack = 1e-9 * (domain.max[a] - domain.min[a]);
      if (!(x[i][a] >= domain.min[a] - slack && x[i][a] <= domain.max[a] + slack))
        bad_input(name_of(scene, body),
                  "particle " + std::to_string(i - first) + " at " + to_text(x[i]) +
                      " is outside the domain along " + "xyz"[a] + " (" + to_text(domain.min[a]) +
                      " .. " + to_text(domain.max[a]) + " m); " +
                      (plane && a == 1 ? "with dimensions: 2 that is the slab which holds all "
                                         "particles; give them such a y"
                                       : "move the body or enlarge the domain"));
      x[i][a] = std::clamp(x[i][a], domain.min[a], domain.max[a]);
    }
    if (plane) x[i][1] = *plane;
  }
}

/// Moves particles from index `first` on that are nearer to a wall than solver.wall_margin to that
/// distance. Refuses moves of more than half a spacing, because layers of particles would coincide.
void hold_off_walls(const Scene& s, std::size_t body, std::size_t first, Particles& all) {
  const double margin = s.solver.wall_margin, d = s.fluid.spacing;
  if (!(margin > 0)) return;
  std::size_t too_far = 0;
  double farthest = 0;
  for (std::size_t i = first; i < all.size(); ++i) {
    double way = 0;
    for (int a = 0; a < 3; a += s.dimensions == 2 ? 2 : 1) {
      double& x = all.position[i][a];
      const double low = s.domain.min[a] + margin, high = s.domain.max[a] - margin, before = x;
      if (x < low && s.domain.has_wall(a, false)) x = low;
      if (x > high && s.domain.has_wall(a, true)) x = high;
      way = std::max(way, std::fabs(x - before));
    }
    if (way > 1e-6 * d) ++all.put_on_margin;  // less is rounding
    if (way > 0.5 * d * (1 + 1e-6)) ++too_far;
    farthest = std::max(farthest, way);
  }
  all.farthest_put = std::max(all.farthest_put, farthest);
  if (too_far == 0) return;
  bad_input(name_of(s, body),
            std::to_string(too_far) + " particles are nearer to a wall than solver.wall_margin (" +
                to_text(margin) + " m) by more than half of fluid.spacing, the farthest by " +
                to_text(farthest) +
                " m; move the body away from the walls or lower solver.wall_margin");
}

/// In two dimensions the y of a velocity must be 0. body.velocity is checked with the scene.
void refuse_velocity_along_y(const Scene& scene, std::size_t body, const std::vector<Double3>& v) {
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i][1] != 0)
      bad_input(name_of(scene, body),
                "particle " + std::to_string(i) + " has velocity " + to_text(v[i]) +
                    "; with dimensions: 2 its y component must be 0: set it so in the file, or "
                    "give dimensions: 3");
}

/// Positions that obstacles leave free: at least 0.4 spacings away from every obstacle.
class FreePlaces {
 public:
  explicit FreePlaces(const Scene& scene)
      : solids_(solids_of(scene)),
        origin_(scene.origin()),
        plane_(scene.plane()),
        h_(scene.h()),
        least_(least_distance(scene) / scene.h()) {}
  bool all() const { return solids_.empty(); }
  bool has(Double3 x) const {
    if (plane_) x[1] = *plane_;
    const Vec3<double> at{(x[0] - origin_[0]) / h_, (x[1] - origin_[1]) / h_,
                          (x[2] - origin_[2]) / h_};
    return std::ranges::none_of(solids_, [&](const Solid<double>& s) {
      return (plane_ ? distance<2>(s, at) : distance<3>(s, at)) < least_;
    });
  }

 private:
  std::vector<Solid<double>> solids_;
  Double3 origin_;
  std::optional<double> plane_;
  double h_, least_;
};

/// Removes the particles from `first` on that are in obstacles and returns their number.
std::size_t drop_inside(const FreePlaces& free, std::size_t first, Particles& all) {
  std::size_t to = first;
  for (std::size_t i = first; i < all.size(); ++i) {
    if (!free.has(all.position[i])) continue;
    all.position[to] = all.position[i];
    all.velocity[to++] = all.velocity[i];
  }
  const std::size_t dropped = all.size() - to;
  all.position.resize(to);
  all.velocity.resize(to);
  return dropped;
}

}  // namespace

StartPoints::StartPoints(const Scene& scene, const std::string& scene_dir) : scene_(scene) {
  of_files_.resize(scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) try {
      if (scene.bodies[b].shape != Shape::file) continue;
      const std::string path = (std::filesystem::path(scene_dir) / scene.bodies[b].path).string();
      SceneFile& file = files_.emplace_back(SceneFile{scene.bodies[b].path, ""});
      of_files_[b] = read_particle_file(path, &file.sha256);
      if (of_files_[b].size() == 0) bad_input(path, "holds no particles");
    } catch (const Error& e) {
      throw Error(e.code(), name_of(scene, b) + ".path: " + e.what());
    }
  for (SceneFile& file : motion_files(scene)) files_.push_back(std::move(file));
}

std::int64_t count_particles(const StartPoints& points) {
  const Scene& scene = points.scene();
  double sum = 0;
  const FreePlaces free(scene);
  if (!free.all()) points.for_each([&](std::size_t, const Double3& x) { sum += free.has(x); });
  for (std::size_t b = 0; b < scene.bodies.size() && free.all(); ++b)
    sum += scene.bodies[b].shape == Shape::file
               ? double(points.of_file(b).size())
               : lattice_count(scene.bodies[b], scene.fluid.spacing, scene.plane());
  if (sum < 1)
    bad_input("bodies", std::string("the scene has 0 particles") +
                            (free.all() ? "; add a body or lower fluid.spacing"
                                        : " outside the obstacles; move the bodies or the "
                                          "obstacles"));
  if (sum > kMaxParticles) bad_input("bodies", too_many_text(sum));
  return static_cast<std::int64_t>(sum);
}

Particles emit_particles(StartPoints points) {
  const Scene& scene = points.scene();
  const auto total = static_cast<std::size_t>(count_particles(points));
  const FreePlaces free(scene);
  Particles all;
  all.files = points.files();
  all.position.reserve(total);
  all.velocity.reserve(total);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const std::size_t first = all.size();
    if (body.shape == Shape::file) {
      const Particles p = points.take_file(b);
      if (scene.dimensions == 2) refuse_velocity_along_y(scene, b, p.velocity);
      all.position.insert(all.position.end(), p.position.begin(), p.position.end());
      all.velocity.insert(all.velocity.end(), p.velocity.begin(), p.velocity.end());
    } else {
      for_each_point(body, scene.fluid.spacing, scene.plane(),
                     [&](const Double3& x) { all.position.push_back(x); });
    }
    all.velocity.resize(all.position.size(), Double3{});
    for (std::size_t i = first; i < all.size(); ++i)
      for (int a = 0; a < 3; ++a) all.velocity[i][a] += body.velocity[a];
    hold_inside(scene, b, first, all.position);
    if (!free.all()) all.in_obstacles.push_back(drop_inside(free, first, all));
    hold_off_walls(scene, b, first, all);
  }
  return all;
}

}  // namespace pbf::run_module
