#include "lib/run/emit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "lib/base/error.h"
#include "lib/io/mesh_file.h"
#include "lib/io/particle_file.h"
#include "lib/program/emission.h"
#include "lib/program/obstacles.h"
#include "lib/run/linked_files.h"
#include "lib/scene/number.h"

namespace pbf::run_module {
namespace {

/// "scene.yaml:4:30: bodies[0]", for messages about the particles of this body.
std::string name_of(const Scene& scene, std::size_t body) {
  const std::string& place = scene.bodies[body].place.text;
  return (place.empty() ? "" : place + ": ") + "bodies[" + std::to_string(body) + "]";
}

/// The particles of one body on their way into the scene.
class IntoScene {
 public:
  IntoScene(const Scene& scene, std::size_t body) : scene_(scene), body_(body) {}

  /// Refuses a particle outside the domain. One that is outside only by rounding (a sphere that
  /// touches a wall) is put on the wall. In two dimensions it is put on the plane.
  void hold_inside(Double3& x) {
    const Domain& domain = scene_.domain;
    // Only particles from a file have a y of their own.
    if (plane_ && !scene_.bodies[body_].from_file()) x[1] = *plane_;
    for (int a = 0; a < 3; ++a) {
      const double slack = 1e-9 * (domain.max[a] - domain.min[a]);
      if (!(x[a] >= domain.min[a] - slack && x[a] <= domain.max[a] + slack))
        bad_input(name_of(scene_, body_),
                  "particle " + std::to_string(seen_) + " at " + to_text(x) +
                      " is outside the domain along " + "xyz"[a] + " (" + to_text(domain.min[a]) +
                      " .. " + to_text(domain.max[a]) + " m); " +
                      (plane_ && a == 1 ? "with dimensions: 2 that is the slab which holds all "
                                          "particles; give them such a y"
                                        : "move the body or enlarge the domain"));
      x[a] = std::clamp(x[a], domain.min[a], domain.max[a]);
    }
    if (plane_) x[1] = *plane_;
    ++seen_;
  }
  /// Moves a particle that is nearer to a wall than solver.wall_margin to that distance.
  void hold_off_walls(Double3& x) {
    const double margin = scene_.solver.wall_margin, d = scene_.fluid.spacing;
    if (!(margin > 0)) return;
    double way = 0;
    for (int a = 0; a < 3; a += scene_.dimensions == 2 ? 2 : 1) {
      const double low = scene_.domain.min[a] + margin, high = scene_.domain.max[a] - margin,
                   before = x[a];
      if (x[a] < low && scene_.domain.has_wall(a, false)) x[a] = low;
      if (x[a] > high && scene_.domain.has_wall(a, true)) x[a] = high;
      way = std::max(way, std::fabs(x[a] - before));
    }
    if (way > 1e-6 * d) ++put_on_margin_;  // less is rounding
    if (way > 0.5 * d * (1 + 1e-6)) ++too_far_;
    farthest_ = std::max(farthest_, way);
  }
  /// After the last one. Refuses moves of more than half a spacing, because layers of particles
  /// would coincide.
  void end(Particles& all) const {
    all.put_on_margin += put_on_margin_;
    all.farthest_put = std::max(all.farthest_put, farthest_);
    if (too_far_ == 0) return;
    bad_input(name_of(scene_, body_),
              std::to_string(too_far_) +
                  " particles are nearer to a wall than solver.wall_margin (" +
                  to_text(scene_.solver.wall_margin) +
                  " m) by more than half of fluid.spacing, the farthest by " + to_text(farthest_) +
                  " m; move the body away from the walls or lower solver.wall_margin");
  }

 private:
  const Scene& scene_;
  const std::size_t body_;
  const std::optional<double> plane_ = scene_.plane();
  std::size_t seen_ = 0, put_on_margin_ = 0, too_far_ = 0;
  double farthest_ = 0;  // m
};

/// In two dimensions the y of a velocity must be 0. body.velocity is checked with the scene.
void refuse_velocity_along_y(const Scene& scene, std::size_t body, const std::vector<Double3>& v) {
  for (std::size_t i = 0; i < v.size(); ++i)
    if (v[i][1] != 0)
      bad_input(name_of(scene, body),
                "particle " + std::to_string(i) + " has velocity " + to_text(v[i]) +
                    "; with dimensions: 2 its y component must be 0: set it so in the file, or "
                    "give dimensions: 3");
}

/// Positions that obstacles and casings of emitters leave free: at least 0.4 spacings away.
class FreePlaces {
 public:
  explicit FreePlaces(const Scene& scene)
      : solids_(solids_of(scene)),
        origin_(scene.origin()),
        plane_(scene.plane()),
        h_(scene.h()),
        least_(least_distance(scene) / scene.h()) {
    for (const Solid<double>& casing : casings_of(scene)) solids_.push_back(casing);
  }
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

/// A mesh that is much larger than the domain would have more lines of lattice points than fit into
/// memory, however thin it is.
void refuse_beyond_domain(const Scene& scene, const TriangleMesh& mesh, const std::string& path) {
  const auto [low, high] = box_of(mesh);
  for (std::size_t a = 0; a < 3; a += scene.plane() ? 2 : 1) {
    const double from = scene.domain.min[a], to = scene.domain.max[a], d = scene.fluid.spacing;
    if (low[a] < from - d || high[a] > to + d)
      bad_input(path, std::string("is outside the domain along ") + "xyz"[a] +
                          ": it reaches from " + to_text(low[a]) + " to " + to_text(high[a]) +
                          " m, and the domain from " + to_text(from) + " to " + to_text(to) +
                          "; move it, lower scale or enlarge the domain");
  }
}

/// The lattice points in a mesh.
Particles fill_mesh(const Scene& scene, const Body& body, const std::string& path,
                    std::string* sha256) {
  TriangleMesh mesh = read_mesh_file(path, sha256);
  require_closed(mesh, path);
  place(mesh, {body.scale, body.turn_axis, body.turn_angle, body.translate});
  const double d = scene.fluid.spacing, count = volume_of(mesh) / (d * d * d);
  if (!scene.plane() && count > kMaxParticles) bad_input(path, too_many_text(count));
  refuse_beyond_domain(scene, mesh, path);
  Particles p;
  p.position = points_in(mesh, d, scene.plane());
  p.velocity.resize(p.size());
  if (p.size() == 0)
    bad_input(path, "holds no point of a lattice of fluid.spacing (" + to_text(d) +
                        " m); lower that or raise scale");
  return p;
}

/// Calls take(position, velocity) for every particle in the order of ids. Returns what Particles
/// say besides. last: frees the particles of each file after its body.
template <class Take>
Particles each_particle(StartPoints& points, bool last, const Take& take) {
  const Scene& scene = points.scene();
  const FreePlaces free(scene);
  Particles all;
  all.files = points.files();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    IntoScene into(scene, b);
    std::size_t dropped = 0;
    const auto put = [&](Double3 x, Double3 v) {
      for (int a = 0; a < 3; ++a) v[a] += body.velocity[a];
      into.hold_inside(x);
      if (!free.all() && !free.has(x)) return void(++dropped);
      into.hold_off_walls(x);
      take(x, v);
    };
    if (body.from_file()) {
      const Particles& p = points.of_file(b);
      if (scene.dimensions == 2) refuse_velocity_along_y(scene, b, p.velocity);
      for (std::size_t i = 0; i < p.size(); ++i) put(p.position[i], p.velocity[i]);
      if (last) points.drop_file(b);
    } else {
      for_each_point(body, scene.fluid.spacing, scene.plane(),
                     [&](const Double3& x) { put(x, Double3{}); });
    }
    if (!free.all()) all.in_obstacles.push_back(dropped);
    into.end(all);
  }
  for_each_in_pipes(scene, take);
  return all;
}

}  // namespace

StartPoints::StartPoints(const Scene& scene, const std::string& scene_dir) : scene_(scene) {
  of_files_.resize(scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) try {
      const Body& body = scene.bodies[b];
      if (!body.from_file()) continue;
      const std::string path = (std::filesystem::path(scene_dir) / body.path).string();
      SceneFile& file = files_.emplace_back(SceneFile{body.path, ""});
      of_files_[b] = body.shape == Shape::mesh ? fill_mesh(scene, body, path, &file.sha256)
                                               : read_particle_file(path, &file.sha256);
      if (of_files_[b].size() == 0) bad_input(path, "holds no particles");
    } catch (const Error& e) {
      throw Error(e.code(), name_of(scene, b) + ".path: " + e.what());
    }
  for (SceneFile& file : linked_files(scene)) files_.push_back(std::move(file));
}

std::int64_t count_particles(const StartPoints& points) {
  const Scene& scene = points.scene();
  double sum = 0;
  const FreePlaces free(scene);
  if (!free.all()) points.for_each([&](std::size_t, const Double3& x) { sum += free.has(x); });
  for (std::size_t b = 0; b < scene.bodies.size() && free.all(); ++b)
    sum += scene.bodies[b].from_file()
               ? double(points.of_file(b).size())
               : lattice_count(scene.bodies[b], scene.fluid.spacing, scene.plane());
  sum += double(particles_in_pipes(scene));
  if (sum < 1)
    bad_input("bodies", std::string("the scene has 0 particles") +
                            (free.all() ? "; add a body or lower fluid.spacing"
                                        : " outside the obstacles; move the bodies or the "
                                          "obstacles"));
  if (sum > kMaxParticles) bad_input("bodies", too_many_text(sum));
  return static_cast<std::int64_t>(sum);
}

Particles emit_particles(StartPoints points) {
  const auto total = static_cast<std::size_t>(count_particles(points));
  Particles rows;
  rows.position.reserve(total);
  rows.velocity.reserve(total);
  Particles all = each_particle(points, true, [&](const Double3& x, const Double3& v) {
    rows.position.push_back(x);
    rows.velocity.push_back(v);
  });
  all.position = std::move(rows.position);
  all.velocity = std::move(rows.velocity);
  return all;
}

Particles emit_in_pieces(StartPoints& points, std::int64_t most, const TakeParticles& take) {
  Particles piece;
  std::int64_t first = 0;
  const auto give = [&] {
    const auto n = std::int64_t(piece.size());
    if (take && n > 0) take(first, std::exchange(piece, {}));
    first += n;
    piece.position.clear();
    piece.velocity.clear();
  };
  Particles all = each_particle(points, false, [&](const Double3& x, const Double3& v) {
    piece.position.push_back(x);
    piece.velocity.push_back(v);
    if (std::int64_t(piece.size()) == most) give();
  });
  give();
  return all;
}

}  // namespace pbf::run_module
